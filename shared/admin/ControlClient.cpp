#include "shared/admin/ControlClient.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "shared/admin/AdminJson.h"
#include "shared/admin/ControlPath.h"

namespace naiad {

namespace {

/// Folder with the control sockets of the packaged service.
constexpr const char* kSystemFolder = "/run/naiad/admin";

/// Returns a connected socket; on failure a negative number, with the reason in errno.
int connectTo(const std::filesystem::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.string().size() >= sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::strcpy(address.sun_path, path.c_str());
  const int descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return -1;
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return descriptor;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return -1;
}

std::string whyNot(int error) {
  if (error == ENOENT || error == ECONNREFUSED) return "no server is listening";
  if (error == EACCES) return "permission denied";
  return std::strerror(error);
}

}  // namespace

ControlClient::ControlClient(const std::filesystem::path& path) : m_socket(connectTo(path)) {
  if (m_socket < 0)
    throw ServerUnreachable("Cannot connect to " + path.string() + ": " + whyNot(errno) + ".");
}

ControlClient::~ControlClient() {
  ::close(m_socket);
}

AdminAnswer ControlClient::sendRequest(const AdminRequest& request) {
  const std::string line = requestLine(request);
  for (std::size_t sent = 0; sent < line.size();) {
    const ssize_t size = ::send(m_socket, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (size < 0 && errno != EINTR) break;  // the reason that the server sent may still be readable
    if (size > 0) sent += static_cast<std::size_t>(size);
  }
  AnswerReader reader;
  const bool takes_long = request.of("when") == "keep";
  for (std::string text; readLine(text, takes_long ? kReplayTimeout : kResponseTimeout);) {
    const AnswerReader::LineKind got = reader.readLine(text);
    if (got == AnswerReader::LineKind::kAnswer) return reader.answer();
    if (got == AnswerReader::LineKind::kMalformed)
      throw ServerUnreachable("This is not a Naiad server's control socket.");
  }
  throw ServerUnreachable("The server closed the connection.");
}

void ControlClient::follow(const std::function<void(const std::string&)>& show) {
  AnswerReader reader;
  for (std::string text; readLine(text, std::chrono::milliseconds(-1));) {
    const AnswerReader::LineKind got = reader.readLine(text);
    if (got == AnswerReader::LineKind::kEvent) show(reader.event());
    if (got == AnswerReader::LineKind::kDropped)
      show("(" + std::to_string(reader.dropped()) + " lines were dropped)");
  }
}

bool ControlClient::readLine(std::string& line, std::chrono::milliseconds timeout) {
  for (;;) {
    if (const std::size_t end = m_in.find('\n'); end != std::string::npos) {
      line = m_in.substr(0, end);
      m_in.erase(0, end + 1);
      return true;
    }
    pollfd ready{m_socket, POLLIN, 0};
    const int count = ::poll(&ready, 1, static_cast<int>(timeout.count()));
    if (count == 0) throw ServerUnreachable("The server does not answer.");
    if (count < 0 && errno == EINTR) continue;
    char piece[4096];
    const ssize_t size = ::recv(m_socket, piece, sizeof piece, 0);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    m_in.append(piece, static_cast<std::size_t>(size));
  }
}

std::vector<std::filesystem::path> findControlSockets() {
  std::vector<std::filesystem::path> found;
  std::vector<std::filesystem::path> all = controlSockets(kSystemFolder);
  if (const auto folder = controlFolder()) {
    for (const auto& path : controlSockets(*folder)) all.push_back(path);
  }
  for (const auto& path : all) {
    const int descriptor = connectTo(path);
    if (descriptor < 0 && errno != EACCES) continue;
    if (descriptor >= 0) ::close(descriptor);
    found.push_back(path);
  }
  return found;
}

}  // namespace naiad
