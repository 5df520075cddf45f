// Takes commands from programs of this machine (dfctl): a socket of the file system, one JSON object a line
// (AdminJson.h). Who may write to its file is an admin.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include "host/admin/AdminPlayer.h"
#include "host/process/WatchFeed.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"
#include "shared/program/LineLog.h"

namespace naiad {

struct ControlListening {
  std::filesystem::path path;  ///< of the file, 103 bytes at most
  /// Connections at once. The last place is kept for short commands: a connection there cannot watch, and
  /// ends after `short_time`.
  std::size_t max_connections = 8;
  std::chrono::milliseconds short_time{2000};
  /// Programs that may give no commands, by their process: what the server has started itself. May be empty.
  /// On the socket's thread, once for each connection.
  std::function<bool(pid_t process)> is_refused = nullptr;
};

/// It has a thread of its own, which does all that waits for a reader: one that stalls costs the tick
/// nothing. Of a watcher that stalls events are dropped, and their number is sent once it reads on.
class ControlSocket {
 public:
  /// Carries out a command. On the socket's thread; `done` may be called from any thread, once, also after
  /// the socket is gone.
  using Execute =
      std::function<void(AdminRequest request, AdminCaller caller, std::function<void(AdminAnswer)> done)>;

  /// Listens from now on. Throws ListenError (ControlFile.h). `feed`: what watchers see; outlives this.
  ControlSocket(ControlListening options, Execute execute, WatchFeed& feed, LogLine log);
  /// Removes the file. Answers that were given are written first, unless that takes longer than a moment.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Bytes that may wait for one watcher, at most.
  static constexpr std::size_t kMaxUnread = std::size_t{64} << 10;

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace naiad
