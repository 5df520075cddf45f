// The plain data of a world, which its parts share.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Layer.h"
#include "Random.h"
#include "Runner.h"

namespace df {

/// The part of WorldState that World::shutDown() resets.
struct RoundState {
  bool paused = false;     ///< World::setPaused()
  bool game_over = false;  ///< World::isGameOver()
  int step_count = 0;      ///< ticks begun since the world began
  unsigned started = 0;    ///< bits of Started.h
  Random random;
  std::vector<std::string> help;  ///< World::setHelp()
};

struct WorldState : RoundState {
  bool compat = false;      ///< World::setCompat()
  bool begun = false;       ///< World::hasBegun()
  bool is_default = false;  ///< true for the world of threads without a current world
  std::uint64_t seed = 1;
  Runner* p_runner = nullptr;
  std::vector<std::unique_ptr<Layer>> layers;
};

}  // namespace df
