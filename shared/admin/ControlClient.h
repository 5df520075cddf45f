// Client side of a server's control socket.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shared/admin/AdminAnswer.h"
#include "shared/admin/AdminRequest.h"

namespace naiad {

/// Thrown if there is no server, or it does not answer as a server does. what() is one sentence.
class ServerUnreachable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A connection to a server's control socket. All calls block.
class ControlClient {
 public:
  /// Time without data after which a request fails, because a server whose game hangs sends no answer.
  static constexpr std::chrono::seconds kResponseTimeout{10};
  /// Like kResponseTimeout, for "restart keep": before its answer, the server replays its rounds. The server
  /// aborts a replay after an hour. If it ends, it closes the connection, so the limit is not reached.
  static constexpr std::chrono::seconds kReplayTimeout{4000};

  /// Connects. Throws ServerUnreachable if that fails.
  explicit ControlClient(const std::filesystem::path& path);
  ~ControlClient();
  ControlClient(const ControlClient&) = delete;
  ControlClient& operator=(const ControlClient&) = delete;

  /// Sends a request and waits for its answer. Throws ServerUnreachable if none comes.
  AdminAnswer sendRequest(const AdminRequest& request);
  /// Call after "watch" was answered. Until the connection ends, calls `show` for each line of the log, and
  /// with a note for lines that the server dropped.
  void follow(const std::function<void(const std::string& line)>& show);

 private:
  /// False if the connection ended. Throws ServerUnreachable after `timeout` without data; negative: none.
  bool readLine(std::string& line, std::chrono::milliseconds timeout);

  int m_socket;
  std::string m_in;
};

/// Returns the control sockets of this user and of /run/naiad/admin on which a server listens, and those that
/// this user may not open.
std::vector<std::filesystem::path> findControlSockets();

}  // namespace naiad
