// A game that is a program itself is a server: what GM.startUp() and GM.run() do in it.
//
// startUp() reads the options (HostOptions.h: environment, then df-config.txt) and seeds the dice; run()
// hosts the game as dfserver would, says how to join, and where there is a terminal attaches a client to it.
// In a process that such a host has started for one of its worlds (WorldStart.h), both serve that host
// instead. A run that the game itself ends may be followed by another, as after a title of its own: players
// join again, and the client in the terminal is another one. Options that make no sense end the process with
// code 2, an address that cannot be listened on with 4, files and keys that cannot be used with 5, each with
// one line on stderr.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "engine/world/Runner.h"
#include "host/settings/HostOptions.h"

namespace naiad {

class ProgramHost : public df::running::Program {
 public:
  void startUp(df::World& world) override;
  void run(df::World& world) override;

 private:
  void seed(df::World& world) const;
  void runHeadless(df::World& world);
  void serve(df::World& world);

  bool m_started = false;  ///< startUp() was called
  HostOptions m_options;
  std::set<std::string> m_given;      ///< names of options that the environment or df-config.txt gave
  int m_ticks = 0;                    ///< without players, in all runs
  bool m_stopped = false;             ///< by a signal, an option or the last player who left, not by the game
  std::optional<int> m_world_socket;  ///< of a process that was started for a world
};

}  // namespace naiad
