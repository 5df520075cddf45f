// The scene of the suite `path`: 200 coloured characters that walk about on 80×24, 30 times a second. All
// compared programs show this simulation. It depends only on its seed and the number of ticks.
//
// 80 % walk at up to ±0.5 cells per tick across and ±0.25 down, 10 % stand still, 10 % run at ±1 across. In
// each tick 1 % of them turn, 2 % change their character, 0.2 % die while another one is born elsewhere; at
// the edge of the screen they bounce.
#pragma once

#include <cstdint>
#include <vector>

#include "Picture.h"

namespace bench::path {

inline constexpr int kCrowd = 200;             ///< walkers
inline constexpr double kTicksPerSecond = 30;  ///< equal in all programs
inline constexpr int kUnits = 1024;            ///< units of position and velocity per cell

/// One character. Positions and velocities are in 1/1024 cell, so that fixed point and floating point both
/// move it exactly.
struct Walker {
  std::uint32_t id = 0;  ///< ascending by birth, never reused
  int x = 0;             ///< drawn in the cell floor(x / kUnits + 0.5)
  int y = 0;
  int vx = 0;  ///< units per tick
  int vy = 0;
  char ch = ' ';
  std::uint8_t color = 0;
};

class Crowd {
 public:
  explicit Crowd(std::uint64_t seed);

  /// First all walkers decide (turn, change, die, bounce), then all move by their velocities.
  void tick();
  /// Returns the number of ticks so far.
  std::uint32_t ticks() const { return m_ticks; }
  /// Returns the walkers in order of birth. Later ones are drawn over earlier ones.
  const std::vector<Walker>& walkers() const { return m_walkers; }

 private:
  std::uint32_t random(std::uint32_t below);
  bool chance(std::uint32_t per_mille) { return random(1000) < per_mille; }
  int within(int range);
  Walker newborn();
  void turn(Walker& walker);
  bool decide(Walker& walker);  // false if it died

  std::uint64_t m_state;
  std::uint32_t m_ticks = 0;
  std::uint32_t m_next_id = 0;
  std::vector<Walker> m_walkers;
};

}  // namespace bench::path
