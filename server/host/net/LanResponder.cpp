#include "host/net/LanResponder.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace naiad {

LanResponder::LanResponder(LanAnswer facts, std::string address, LanMode mode)
    : m_address(std::move(address)),
      m_mode(mode),
      m_judge(std::move(facts)),
      m_sockets(openLanSockets(&LanSocket::forServer)),
      m_wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (m_wake < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

LanResponder::~LanResponder() {
  stop();
  ::close(m_wake);
}

void LanResponder::start() {
  if (m_thread.joinable() || m_stopping) return;
  m_thread = std::thread([this] { run(); });
}

void LanResponder::stop() {
  m_stopping = true;
  if (!m_thread.joinable()) return;
  const std::uint64_t one = 1;
  [[maybe_unused]] const ssize_t written = ::write(m_wake, &one, sizeof one);
  m_thread.join();
}

void LanResponder::run() {
  auto next_refresh = std::chrono::steady_clock::now();
  while (!m_stopping) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= next_refresh) {
      refresh();
      next_refresh = now + kRefresh;
    }
    bool more = false;
    for (LanSocket& socket : m_sockets) more = serve(socket) || more;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next_refresh - now);
    more ? wait(false, kPause) : wait(true, left);
  }
}

void LanResponder::refresh() {
  m_judge.setNetworks(answeredNetworks(lanNetworks(), m_address, m_mode));
  for (const LanNetwork& network : m_judge.networks()) {
    for (LanSocket& socket : m_sockets) {
      const bool same = (socket.family() == LanSocket::Family::kIPv4) == network.address.is_v4();
      if (same) socket.joinGroup(network.interface);
    }
  }
}

/// False when no packet waits any more.
bool LanResponder::serve(LanSocket& socket) {
  for (int i = 0; i < kTurn; ++i) {
    const auto packet = socket.receivePacket();
    if (!packet) return false;
    const auto reply = m_judge.judgePacket(*packet, m_players.load(std::memory_order_relaxed),
                                           std::chrono::steady_clock::now());
    if (reply && !socket.sendAnswer(*reply->p_network, packet->source, reply->bytes)) m_judge.noteUnsent();
  }
  return true;
}

/// For stop(), for packets as well if `sockets` is true, and not longer than `time`.
void LanResponder::wait(bool sockets, std::chrono::milliseconds time) {
  std::vector<pollfd> waited{{m_wake, POLLIN, 0}};
  for (const LanSocket& socket : m_sockets) {
    if (sockets) waited.push_back({socket.descriptor(), POLLIN, 0});
  }
  ::poll(waited.data(), waited.size(), static_cast<int>(time.count()));
}

}  // namespace naiad
