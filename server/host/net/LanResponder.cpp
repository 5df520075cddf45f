#include "host/net/LanResponder.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

namespace naiad {

namespace {

/// True if a server that listens on `listened` receives what is sent to `address`.
bool hears(const asio::ip::address& listened, const asio::ip::address& address) {
  if (listened == asio::ip::address_v6::any()) return true;
  if (listened == asio::ip::address_v4::any()) return address.is_v4();
  return listened == address;
}

}  // namespace

std::vector<LanNetwork> answeredNetworks(const std::vector<LanNetwork>& networks, const std::string& address,
                                         LanMode mode) {
  std::error_code error;
  const auto listened = asio::ip::make_address(address, error);
  if (error || mode == LanMode::kOff) return {};
  std::vector<LanNetwork> answered;
  bool has_private = false;
  for (const LanNetwork& network : networks) {
    const bool is_open = network.is_loopback || network.is_private || mode == LanMode::kOn;
    if (!is_open || !hears(listened, network.address)) continue;
    has_private = has_private || (network.is_private && !network.is_loopback);
    answered.push_back(network);
  }
  if (mode == LanMode::kAuto && !has_private) return {};
  return answered;
}

const LanNetwork* LanQueryFilter::findNetwork(const LanPacket& packet) const {
  const auto found = std::find_if(m_networks.begin(), m_networks.end(), [&packet](const LanNetwork& network) {
    return network.interface == packet.interface && network.contains(packet.source.address());
  });
  return found == m_networks.end() ? nullptr : &*found;
}

// First makes the cheap tests, and those that a sender outside the link cannot pass.
std::optional<LanQueryFilter::Reply> LanQueryFilter::filter(const LanPacket& packet, std::size_t players,
                                                            Time now) {
  if (packet.hop_limit != kLanHopLimit) {
    ++m_counters.routed;
    return std::nullopt;
  }
  const LanNetwork* p_network = packet.to_group && packet.source.port() != 0 ? findNetwork(packet) : nullptr;
  if (p_network == nullptr) {
    ++m_counters.foreign;
    return std::nullopt;
  }
  const auto nonce = readLanQuery(packet.bytes);
  if (!nonce) {
    ++m_counters.malformed;
    return std::nullopt;
  }
  // Tests the common limit last, so that a sender above its own limit does not use it up.
  TokenBucket& own = m_prefixes.use(AddressPrefix::of(packet.source.address()));
  if (!own.tryConsume(kPrefixRate, now) || !m_all.tryConsume(kTotalRate, now)) {
    ++m_counters.rate_limited;
    return std::nullopt;
  }
  ++m_counters.answered;
  LanAnswer answer = m_facts;
  answer.nonce = *nonce;
  constexpr std::size_t kMaxCount = std::numeric_limits<std::uint16_t>::max();
  answer.players = static_cast<std::uint16_t>(std::min(players, kMaxCount));
  return Reply{p_network, writeLanAnswer(answer)};
}

void LanQueryFilter::countUnsent() {
  --m_counters.answered;
  ++m_counters.unsent;
}

LanResponder::LanResponder(LanAnswer facts, std::string address, LanMode mode)
    : m_address(std::move(address)),
      m_mode(mode),
      m_filter(std::move(facts)),
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
      next_refresh = now + kRefreshInterval;
    }
    bool more = false;
    for (LanSocket& socket : m_sockets) more = serve(socket) || more;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next_refresh - now);
    more ? wait(false, kPollInterval) : wait(true, left);
  }
}

void LanResponder::refresh() {
  m_filter.setNetworks(answeredNetworks(lanNetworks(), m_address, m_mode));
  for (const LanNetwork& network : m_filter.networks()) {
    for (LanSocket& socket : m_sockets) {
      const bool same = (socket.family() == LanSocket::Family::kIPv4) == network.address.is_v4();
      if (same) socket.joinGroup(network.interface);
    }
  }
}

/// Returns false when no packets are left.
bool LanResponder::serve(LanSocket& socket) {
  for (int i = 0; i < kMaxPackets; ++i) {
    const auto packet = socket.receivePacket();
    if (!packet) return false;
    const auto reply =
        m_filter.filter(*packet, m_players.load(std::memory_order_relaxed), std::chrono::steady_clock::now());
    if (reply && !socket.sendAnswer(*reply->p_network, packet->source, reply->bytes)) m_filter.countUnsent();
  }
  return true;
}

/// Waits for stop() and, if `sockets` is true, for packets, but at most for `time`.
void LanResponder::wait(bool sockets, std::chrono::milliseconds time) {
  std::vector<pollfd> waited{{m_wake, POLLIN, 0}};
  for (const LanSocket& socket : m_sockets) {
    if (sockets) waited.push_back({socket.descriptor(), POLLIN, 0});
  }
  ::poll(waited.data(), waited.size(), static_cast<int>(time.count()));
}

}  // namespace naiad
