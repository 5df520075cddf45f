// A client of a control socket, blocking, with timeouts, and a socket without a server.
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace naiad::test {

inline sockaddr_un unixAddress(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof address.sun_path - 1);
  return address;
}

/// Leaves a socket like that of a killed server. False on failure.
inline bool leaveSocket(const std::filesystem::path& path) {
  const sockaddr_un address = unixAddress(path);
  const int dead = ::socket(AF_UNIX, SOCK_STREAM, 0);
  const bool good = ::bind(dead, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(dead);
  return good;
}

class Talk {
 public:
  explicit Talk(const std::filesystem::path& path)
      : m_socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const sockaddr_un address = unixAddress(path);
    // A failure shows in the answer that does not come.
    (void)::connect(m_socket, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  }
  ~Talk() { ::close(m_socket); }
  Talk(const Talk&) = delete;
  Talk& operator=(const Talk&) = delete;

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t size = ::send(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (size <= 0) return;  // the other end has closed the connection
      bytes.remove_prefix(static_cast<std::size_t>(size));
    }
  }
  void shutDown() { ::shutdown(m_socket, SHUT_WR); }
  /// Reads the next line; nullopt if the server closed the connection, or after 60 s.
  std::optional<std::string> readLine() {
    for (;;) {
      if (const std::size_t end = m_in.find('\n'); end != std::string::npos) {
        std::string line = m_in.substr(0, end);
        m_in.erase(0, end + 1);
        return line;
      }
      pollfd ready{m_socket, POLLIN, 0};
      if (::poll(&ready, 1, 60'000) <= 0) return std::nullopt;
      char piece[4096];
      const ssize_t size = ::recv(m_socket, piece, sizeof piece, 0);
      if (size <= 0) return std::nullopt;
      m_in.append(piece, static_cast<std::size_t>(size));
    }
  }
  /// True if there is more to read. Does not wait.
  bool isReadable() const {
    pollfd ready{m_socket, POLLIN, 0};
    return !m_in.empty() || ::poll(&ready, 1, 0) > 0;
  }
  /// Sends a line and returns the last line of its answer.
  std::string ask(const std::string& line) {
    send(line + "\n");
    for (;;) {
      const auto answer = readLine();
      if (!answer) return "(hung up)";
      if (answer->find("\"more\":true") == std::string::npos) return *answer;
    }
  }

 private:
  int m_socket;
  std::string m_in;
};

}  // namespace naiad::test
