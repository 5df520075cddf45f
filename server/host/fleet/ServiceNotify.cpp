#include "host/fleet/ServiceNotify.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "shared/net/base/SafeText.h"
#include "shared/program/LogText.h"

namespace naiad {

namespace {

/// Returns a datagram socket connected to a path, or, if it begins with '@', to an abstract name; -1: failed.
int connectedTo(std::string_view path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const bool is_name = path.starts_with('@');
  if (path.size() < 2 || (!is_name && path.front() != '/') || path.size() >= sizeof address.sun_path)
    return -1;
  std::memcpy(address.sun_path, path.data(), path.size());
  if (is_name) address.sun_path[0] = '\0';
  const std::size_t size = offsetof(sockaddr_un, sun_path) + path.size() + (is_name ? 0 : 1);
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return -1;
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(size)) == 0)
    return socket;
  ::close(socket);
  return -1;
}

std::optional<std::chrono::microseconds> keepAliveTimeOf(const ServiceNotify::Variable& variable) {
  const char* p_time = variable("WATCHDOG_USEC");
  const char* p_process = variable("WATCHDOG_PID");
  const auto within = readNumber<std::int64_t>(p_time != nullptr ? p_time : "", 2, INT64_MAX);
  if (!within || (p_process != nullptr && !readNumber(p_process, getpid(), getpid()))) return std::nullopt;
  return std::chrono::microseconds(*within / 2);
}

}  // namespace

ServiceNotify::ServiceNotify(const Variable& variable) {
  const char* p_path = variable("NOTIFY_SOCKET");
  if (p_path == nullptr) return;
  m_socket = connectedTo(p_path);
  if (isActive()) m_keep_alive = keepAliveTimeOf(variable);
}

ServiceNotify::ServiceNotify() : ServiceNotify([](const char* p_name) { return std::getenv(p_name); }) {}

ServiceNotify::~ServiceNotify() {
  if (isActive()) ::close(m_socket);
}

bool ServiceNotify::send(const std::string& text) const {
  return isActive() && ::send(m_socket, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) >= 0;
}

void ServiceNotify::notifyPlayers(const PlatformPlayers& players) {
  const std::size_t playing = players.ids.size();
  const std::string line =
      players.address + ", " + std::to_string(playing) + (playing == 1 ? " player" : " players");
  if (!isActive() || line == m_status) return;
  if (send("STATUS=" + oneLine(line))) m_status = line;
}

void ServiceNotify::notifyReloading(Clock::time_point now) {
  const auto micros = std::chrono::duration_cast<std::chrono::microseconds>(now.time_since_epoch());
  send("RELOADING=1\nMONOTONIC_USEC=" + std::to_string(micros.count()));
}

void ServiceNotify::notifyTick(Clock::time_point now) {
  if (!m_keep_alive || (m_kept_alive && now - *m_kept_alive < *m_keep_alive)) return;
  if (send("WATCHDOG=1")) m_kept_alive = now;
}

}  // namespace naiad
