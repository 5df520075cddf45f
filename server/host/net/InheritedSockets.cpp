#include "host/net/InheritedSockets.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <asio/ip/tcp.hpp>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <system_error>

#include "shared/net/base/SafeText.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

namespace {

constexpr const char* kExported = "NAIAD_SOCKETS";  ///< variable with process, streams, datagrams, is_service
constexpr int kWanted = 2;
constexpr int kSpare = 16;  ///< lowest descriptor number of duplicates

[[noreturn]] void refuse(const std::string& what) {
  throw ListenError("The sockets from the service manager (LISTEN_FDS) cannot be used: " + what + ".",
                    std::make_error_code(std::errc::invalid_argument));
}

std::optional<long> numberIn(const char* p_text) {
  return readNumber(p_text != nullptr ? p_text : "", LONG_MIN, LONG_MAX);
}

int intOption(int socket, int option) {
  int value = -1;
  socklen_t size = sizeof value;
  return getsockopt(socket, SOL_SOCKET, option, &value, &size) == 0 ? value : -1;
}

/// Returns the address that an Internet socket is bound to.
asio::ip::tcp::endpoint endpointOf(int socket) {
  asio::ip::tcp::endpoint endpoint;
  auto size = static_cast<socklen_t>(endpoint.capacity());
  if (getsockname(socket, endpoint.data(), &size) != 0) refuse(std::generic_category().message(errno));
  const int family = endpoint.data()->sa_family;
  if (family != AF_INET && family != AF_INET6) refuse("one is not an IPv4 or IPv6 socket");
  endpoint.resize(size);
  if (endpoint.port() == 0) refuse("one is not bound to a port");
  return endpoint;
}

/// Stores a socket according to its type, and sets its close-on-exec flag.
void sort(int socket, InheritedSockets& sockets) {
  if (fcntl(socket, F_SETFD, FD_CLOEXEC) != 0)
    refuse("descriptor " + std::to_string(socket) + " is not open");
  const int type = intOption(socket, SO_TYPE);
  if (type != SOCK_STREAM && type != SOCK_DGRAM)
    refuse("descriptor " + std::to_string(socket) + " is not a TCP or UDP socket");
  const bool is_stream = type == SOCK_STREAM;
  int& place = is_stream ? sockets.streams : sockets.datagrams;
  if (place >= 0) refuse(is_stream ? "both are TCP sockets" : "both are UDP sockets");
  if (is_stream && intOption(socket, SO_ACCEPTCONN) != 1) refuse("the TCP socket is not listening");
  place = socket;
}

void setAddress(InheritedSockets& sockets) {
  const auto streams = endpointOf(sockets.streams);
  const auto datagrams = endpointOf(sockets.datagrams);
  if (streams != datagrams) refuse("they have different addresses or ports");
  sockets.address = streams.address().to_string();
  sockets.port = streams.port();
}

/// Returns nullopt if the variable is missing, malformed, or names another process.
std::optional<InheritedSockets> readExported() {
  const char* p_text = std::getenv(kExported);
  if (p_text == nullptr) return std::nullopt;
  std::istringstream numbers(p_text);
  unsetenv(kExported);
  pid_t process = 0;
  int first = -1;
  int second = -1;
  InheritedSockets sockets;
  if (!(numbers >> process >> first >> second >> sockets.is_service) || process != getpid())
    return std::nullopt;
  sort(first, sockets);
  sort(second, sockets);
  setAddress(sockets);
  return sockets;
}

}  // namespace

std::optional<InheritedSockets> InheritedSockets::importSockets(pid_t process, const Variable& variable,
                                                                int first) {
  const char* p_count = variable("LISTEN_FDS");
  if (p_count == nullptr || numberIn(variable("LISTEN_PID")) != process) return std::nullopt;
  const auto count = numberIn(p_count);
  if (!count || *count < 0) refuse(std::string("invalid number \"") + p_count + '"');
  if (*count == 0) return std::nullopt;
  if (*count != kWanted)
    refuse("expected one for TCP and one for UDP, but their number is " + std::to_string(*count));
  InheritedSockets sockets;
  for (int socket = first; socket < first + kWanted; ++socket) sort(socket, sockets);
  setAddress(sockets);
  sockets.is_service = true;
  return sockets;
}

// kSpare is above the numbers that importSockets() examines, because those are in use.
InheritedSockets InheritedSockets::duplicate() const {
  InheritedSockets others = *this;
  for (int* const p_socket : {&others.streams, &others.datagrams}) {
    *p_socket = fcntl(*p_socket, F_DUPFD_CLOEXEC, kSpare);
    if (*p_socket < 0)
      throw std::system_error(errno, std::generic_category(), "cannot duplicate the sockets");
  }
  return others;
}

void InheritedSockets::exportToExec() const {
  for (const int socket : {streams, datagrams}) {
    if (fcntl(socket, F_SETFD, 0) != 0)
      throw std::system_error(errno, std::generic_category(), "cannot pass on the sockets");
  }
  std::ostringstream numbers;
  numbers << getpid() << ' ' << streams << ' ' << datagrams << ' ' << is_service;
  setenv(kExported, numbers.str().c_str(), 1);
}

std::optional<InheritedSockets> InheritedSockets::importSockets() {
  if (auto exported = readExported()) return exported;
  return importSockets(getpid(), [](const char* p_name) { return std::getenv(p_name); });
}

}  // namespace naiad
