// Starts the processes of worlds, and sees to it that none of theirs is left when they end.
//
//   front ── launcher ── keeper ── world ── what the world starts
//
// The launcher is a small copy of the front from before it had keys, passwords of players or threads. It
// makes a keeper for each world. The keeper starts the world in its sandbox, and is the subreaper of all that
// descends from it. When the world has ended, or the front closes or shuts down its end of the keeper's
// socket, by whatever death, the keeper ends all of them, also those that left the world's process group.
// Worlds cannot signal or trace any of the three.
//
// On the keeper's socket the front reads KeeperStart, then one KeeperEnd. Of a world that makes copies of
// itself (WorldOrder::copies) there are more: two for each world that ends and is followed by a copy.
#pragma once

#include <sys/types.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "host/world/Repeatable.h"
#include "host/world/Sandbox.h"

namespace naiad {

/// The process of a world.
struct WorldProgram {
  std::string program;                   ///< an absolute path
  std::vector<std::string> arguments;    ///< its name first
  std::vector<std::string> environment;  ///< "NAME=value"; WorldStart.h adds the socket's number
  std::string directory;
  Sandbox sandbox;
  std::string preload = {};  ///< for LD_PRELOAD of worlds that are to be repeatable (Repeatable.h)
  std::chrono::milliseconds hang_time{1000};  ///< of one tick; then the game hangs (WorldProcess.h)
  int nice = 0;                               ///< added to that of this process, for the world and its keeper
};

struct StartedWorld {
  int socket = -1;  ///< our end of the world's; the caller's to close
  int keeper = -1;  ///< of the keeper's; the caller's to close, which ends the world
  int output = -1;  ///< what it prints, for an OutputRelay; the caller's to close
  int page = -1;    ///< memory that it shares with us, an ActivityPage; the caller's to close
  int copies = -1;  ///< for orders of copies (WorldCopies.h), if it is to make any; the caller's to close
  std::chrono::milliseconds hang_time{1000};  ///< as its WorldProgram has it
  bool hashes = false;   ///< its answers are to be hashed: the order is of a world that can be repeated
  bool repeats = false;  ///< it is executed again: what it prints was printed
};

/// The world's program is executed, or cannot be.
struct KeeperStart {
  std::int32_t error = 0;  ///< errno; then nothing was started
  std::int32_t process = -1;
};

struct KeeperEnd {
  enum Kind : std::int32_t {
    kAll,    ///< all that the world had started has ended, and the keeper ends
    kWorld,  ///< copies are there, and the keeper waits for a KeeperOrder that says which of them goes on
    kRest,   ///< the copy of that order goes on, and of the world before nothing is left
  };
  std::int32_t status = 0;  ///< of the world that ended last, as of waitpid()
  std::int32_t kind = kAll;
};

/// To the keeper of a world that makes copies.
struct KeeperOrder {
  enum Kind : std::int32_t {
    kEndWorld,  ///< end the process of the world alone: it hangs
    kGoOn,      ///< the world has ended: `process` is the world from now on, and all but `kept` end
  } kind = kEndWorld;
  std::int32_t process = 0;
  std::array<std::int32_t, 3> kept{};  ///< other copies; 0: none
};

class WorldLauncher {
 public:
  /// Starts the launcher: better before this process has threads, much memory and secrets. Throws
  /// std::system_error.
  explicit WorldLauncher(WorldProgram program);
  /// Its keepers and worlds stay as long as their sockets are open.
  ~WorldLauncher();
  WorldLauncher(const WorldLauncher&) = delete;
  WorldLauncher& operator=(const WorldLauncher&) = delete;

  /// Start a world with an empty standard input, and a pipe for its standard output and error; with a session
  /// of its own: a Ctrl-C in the terminal is for the front. Does not wait: the keeper says what comes of it.
  /// Throws std::system_error if there is no launcher any more.
  StartedWorld start(const WorldOrder& order = {}) const;
  /// As found out by the launcher; all of it if there is no sandbox.
  const SandboxSupport& support() const { return m_support; }

 private:
  int m_socket = -1;
  pid_t m_process = -1;
  SandboxSupport m_support;
  std::chrono::milliseconds m_hang_time;
};

}  // namespace naiad
