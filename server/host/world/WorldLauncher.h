// Starts the processes of worlds, and makes sure that all their descendants end with them.
//
//   front ── launcher ── supervisor ── world ── the world's descendants
//
// The front is the server's process. The launcher is forked from it before the front has keys, passwords of
// players or threads, and forks a supervisor for each world. If the launcher was killed, the next world gets
// another one, which has a copy of the front's memory; worlds cannot read it, and lose it by execve(). The
// supervisor starts the world in its sandbox, and is the subreaper of its descendants. When the world has
// ended, or when the front closes or shuts down its end of the supervisor's socket, or dies, the supervisor
// ends all of these descendants, including those that left the world's process group. Worlds in a sandbox
// cannot signal or trace any of the three.
//
// On the supervisor's socket the front reads WorldStartReport, then one WorldExitReport. If the world makes
// copies (WorldStartOptions::copies), there are two more for each world that ends and is replaced by a copy.
#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "host/world/Determinism.h"
#include "host/world/Sandbox.h"

namespace naiad {

/// The program that worlds run.
struct WorldProgram {
  std::string program;                   ///< an absolute path
  std::vector<std::string> arguments;    ///< program name first
  std::vector<std::string> environment;  ///< "NAME=value"; the supervisor adds some (WorldStart.h)
  std::string directory;
  Sandbox sandbox;
  std::string preload = {};  ///< LD_PRELOAD of worlds that are to be repeatable (Determinism.h)
  std::chrono::milliseconds hang_time{
      1000};     ///< time limit of a tick; after it the game counts as hung (WorldProcess.h)
  int nice = 0;  ///< difference of the nice value of worlds to that of this process
};

struct StartedWorld {
  int socket = -1;      ///< our end of the world's socket
  int supervisor = -1;  ///< our end of the supervisor's socket; closing it ends the world
  int output = -1;      ///< reading end of the pipe of its output, for an OutputRelay
  int page = -1;        ///< shared memory with an ActivityPage
  int copies = -1;      ///< socket for requests to copy the world (WorldCheckpoints.h); -1: none
  std::chrono::milliseconds hang_time{1000};  ///< as in WorldProgram
  bool hashes = false;                        ///< true: its answers are hashed, because it is repeatable
  bool repeats = false;                       ///< true: it is a replay, whose output was printed before
};

/// Sent when the world's program was executed, or could not be.
struct WorldStartReport {
  std::int32_t error = 0;  ///< errno; if not 0, the program does not run
  std::int32_t process = -1;
};

struct WorldExitReport {
  enum Kind : std::int32_t {
    kAll,    ///< all descendants of the world have ended, and the supervisor ends
    kWorld,  ///< the world has ended; the supervisor waits for a SupervisorCommand with its successor
    kRest,   ///< the successor runs, and nothing of the old world is left
  };
  std::int32_t status = 0;  ///< status of the world that ended last, as of waitpid()
  std::int32_t kind = kAll;
};

/// An order to the supervisor of a world that makes copies.
struct SupervisorCommand {
  enum Kind : std::int32_t {
    kEndWorld,  ///< kill only the world's process, because it hangs or has failed
    kResume,    ///< the world has ended: `process` replaces it; all others but `kept` end
  } kind = kEndWorld;
  std::int32_t process = 0;
  std::array<std::int32_t, 3> kept{};  ///< other copies; 0: none
};

class WorldLauncher {
 public:
  /// Starts the launcher. Call it, if possible, before this process has threads, much memory and secrets.
  /// Throws std::system_error on failure.
  explicit WorldLauncher(WorldProgram program);
  /// Ends the launcher. Supervisors and worlds run on as long as their sockets are open.
  ~WorldLauncher();
  WorldLauncher(const WorldLauncher&) = delete;
  WorldLauncher& operator=(const WorldLauncher&) = delete;

  /// Starts a world with an empty standard input, a pipe as its output, and a session of its own, so that
  /// Ctrl-C in the terminal reaches only the front. Does not wait: the supervisor reports the result. Starts
  /// another launcher if this one has ended. Throws std::system_error on failure.
  StartedWorld start(const WorldStartOptions& order = {}) const;
  /// Returns the features that the launcher found. Without a sandbox only `addresses` is set.
  const SandboxSupport& support() const { return m_support; }

 private:
  void launch() const;
  void endLauncher() const;

  const WorldProgram m_program;
  mutable int m_socket = -1;
  mutable pid_t m_process = -1;
  mutable SandboxSupport m_support;
};

}  // namespace naiad
