// Accepts commands from local programs (dfctl) on a Unix socket, one JSON object per line (AdminJson.h). All
// users with write permission for the socket's file are admins.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "host/admin/AdminPlayer.h"
#include "host/process/EventFeed.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"
#include "shared/program/LineLog.h"

namespace naiad {

struct ControlSocketOptions {
  std::filesystem::path path;  ///< path of the socket, at most 103 bytes
  /// Maximum number of connections. The last one is reserved for short commands: the command "watch" is
  /// refused on it, and it is closed after `short_time`.
  std::size_t max_connections = 8;
  std::chrono::milliseconds short_time{2000};
  /// Returns true for processes that may not give commands, for example because the server started them. If
  /// empty, no process is refused. Called on the socket's thread, once for each connection.
  std::function<bool(pid_t process)> is_refused = nullptr;
};

/// Runs on a thread of its own, so a client that stalls does not delay the tick. If a watcher (a client that
/// has given the command "watch") stalls, its events are dropped; it gets their number when it reads again.
class ControlSocket {
 public:
  /// Executes a command. Called on the socket's thread. `done` must be called once; any thread may call
  /// it, even after the socket is gone.
  using Execute =
      std::function<void(AdminRequest request, AdminCaller caller, std::function<void(AdminAnswer)> done)>;

  /// Begins to listen. Throws ListenError (ControlFile.h). `feed`: events for watchers; must outlive this.
  ControlSocket(ControlSocketOptions options, Execute execute, EventFeed& feed, LogLine log);
  /// Writes the remaining answers (for 300 ms at most) and removes the file.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// With more unsent bytes than this, events for a watcher are dropped.
  static constexpr std::size_t kMaxUnread = std::size_t{64} << 10;

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace naiad
