// Makes a program that contains its game a server: GM.startUp() and GM.run() in such a program.
//
// startUp() reads the options (HostOptions.h: environment, then df-config.txt) and seeds random numbers.
// run() hosts the game like dfserver, prints how to join, and starts a client if there is a terminal. In a
// process that such a host started for one of its worlds (WorldStart.h), both serve that host instead. After
// a run that the game itself ends, another may follow, e.g. after the game's own title screen: players stay
// connected until then or the end of the program; only the terminal gets a new client. Exit codes, each with
// one line on stderr: 1 for a failed game, 2 for invalid options, 4 for an address that cannot be listened
// on, 5 for unusable files and keys.
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "engine/world/Runner.h"
#include "host/loop/Host.h"
#include "host/settings/HostOptions.h"
#include "shared/program/LineLog.h"

namespace naiad {

class ProgramHost : public df::running::Program {
 public:
  void startUp(df::World& world) override;
  void run(df::World& world) override;
  /// Ends the host that waits for another run, if any.
  void finish();

 private:
  void seed(df::World& world) const;
  void runHeadless(df::World& world);
  void serve(df::World& world);

  bool m_started = false;  ///< true after startUp()
  HostOptions m_options;
  std::set<std::string> m_given;  ///< names of the options set by the environment or df-config.txt
  int m_ticks = 0;                ///< number of headless ticks in all runs
  bool m_stopped = false;  ///< true if a signal, an option or the last player ended run(), not the game
  std::optional<int> m_world_socket;  ///< socket to the host, in a process started for a world
  std::unique_ptr<Host> m_waiting;    ///< host that waits for another run; null: none, or in a run
  std::shared_ptr<LineLog> m_lines;   ///< its log; null: the file of the game
};

}  // namespace naiad
