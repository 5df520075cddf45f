#include "host/net/ListeningSockets.h"

#include <sys/socket.h>

#include <asio/ip/tcp.hpp>
#include <charconv>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace naiad {

namespace {

using StreamEndpoint = asio::ip::tcp::endpoint;

int socketOption(int socket, int option) {
  int value = -1;
  socklen_t size = sizeof value;
  return getsockopt(socket, SOL_SOCKET, option, &value, &size) == 0 ? value : -1;
}

/// Nothing for what is no socket of the Internet.
std::optional<StreamEndpoint> boundTo(int socket) {
  StreamEndpoint endpoint;
  auto size = static_cast<socklen_t>(endpoint.capacity());
  if (getsockname(socket, endpoint.data(), &size) != 0) return std::nullopt;
  const int family = endpoint.data()->sa_family;
  if (family != AF_INET && family != AF_INET6) return std::nullopt;
  endpoint.resize(size);
  return endpoint;
}

std::vector<int> openDescriptors() {
  std::vector<int> numbers;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int number = -1;
    std::from_chars(name.data(), name.data() + name.size(), number);
    numbers.push_back(number);
  }
  return numbers;
}

/// The socket of this type on that port, and on that address if one is given; -1: there is none.
int findSocket(int type, std::uint16_t port, const std::optional<StreamEndpoint>& address) {
  for (const int socket : openDescriptors()) {
    const auto endpoint = boundTo(socket);
    if (!endpoint || endpoint->port() != port || socketOption(socket, SO_TYPE) != type) continue;
    if (type == SOCK_STREAM && socketOption(socket, SO_ACCEPTCONN) != 1) continue;
    if (!address || *endpoint == *address) return socket;
  }
  return -1;
}

}  // namespace

std::optional<InheritedSockets> copyListeningSockets(std::uint16_t port) {
  InheritedSockets sockets;
  sockets.streams = findSocket(SOCK_STREAM, port, std::nullopt);
  if (sockets.streams < 0) return std::nullopt;
  const auto endpoint = boundTo(sockets.streams);
  sockets.datagrams = findSocket(SOCK_DGRAM, port, endpoint);
  if (sockets.datagrams < 0) return std::nullopt;
  sockets.address = endpoint->address().to_string();
  sockets.port = port;
  return sockets.duplicate();
}

}  // namespace naiad
