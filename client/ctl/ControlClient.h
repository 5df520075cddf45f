// dfctl's end of a server's control socket.
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

/// There is no server, or it does not answer. what() is one sentence.
class NoServer : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Blocking.
class ControlClient {
 public:
  /// For an answer: a server whose game hangs gives none.
  static constexpr std::chrono::seconds kPatience{10};
  /// The same while rounds are executed again (restart --keep): the server ends what takes longer than an
  /// hour. One that ends itself hangs up.
  static constexpr std::chrono::seconds kLongPatience{4000};

  /// Throws NoServer.
  explicit ControlClient(const std::filesystem::path& path);
  ~ControlClient();
  ControlClient(const ControlClient&) = delete;
  ControlClient& operator=(const ControlClient&) = delete;

  /// Throws NoServer.
  AdminAnswer ask(const AdminRequest& request);
  /// After "watch" was answered: call `show` for each line of the log until the server ends.
  void follow(const std::function<void(const std::string& line)>& show);

 private:
  /// False: the server has hung up. Throws NoServer after `patience`; negative: waits for ever.
  bool readLine(std::string& line, std::chrono::milliseconds patience);

  int m_socket;
  std::string m_in;
};

/// The sockets, of those that controlPath() names and of /run/naiad, on which a server listens.
std::vector<std::filesystem::path> liveControls();

}  // namespace naiad
