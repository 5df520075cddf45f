// A server, its bots and the network between them, for some virtual time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "Bot.h"
#include "Judge.h"
#include "Tally.h"
#include "VirtualHost.h"
#include "engine/world/World.h"

namespace naiad::soak {

struct SoakOptions {
  int bots = 64;
  double minutes = 60;
  double haste = 1;          ///< factor for the rate of events
  std::uint32_t stride = 5;  ///< every `stride`-th tick of each player is compared
};

class Soak {
 public:
  explicit Soak(const SoakOptions& options);
  ~Soak();

  /// Runs the test, prints progress on stderr and the result on stdout. True if nothing went wrong.
  bool run();

 private:
  void tick();
  void hear(const Heard& heard);
  void report() const;
  void finish();
  bool isQuiet(Bot& bot) const;
  void measureMemory(double minute);
  /// Returns the growth of memory after the warm-up, in percent; nullopt if the run was too short.
  std::optional<double> memoryGrowth() const;
  bool conclude();

  SoakOptions m_options;
  VirtualClock m_clock;
  VirtualNetwork m_network;
  test::Census m_census;
  df::World m_world;
  df::World::Scope m_scope;
  VirtualHost m_host;
  Tally m_tally;
  Judge m_judge;
  std::vector<std::unique_ptr<Bot>> m_bots;
  std::uint64_t m_ticks = 0;
  int m_unwell = 0;             ///< clients with a wrong picture, or without datagrams, at the end
  std::vector<double> m_early;  ///< samples of the bytes in use, soon after the warm-up
  std::vector<double> m_late;
};

}  // namespace naiad::soak
