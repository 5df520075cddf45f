#include "host/net/LanQueryJudge.h"

#include <algorithm>
#include <limits>

namespace naiad {

namespace {

/// Does a server on this address hear what is sent to that one?
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

const LanNetwork* LanQueryJudge::findNetwork(const LanPacket& packet) const {
  const auto found = std::find_if(m_networks.begin(), m_networks.end(), [&packet](const LanNetwork& network) {
    return network.interface == packet.interface && network.contains(packet.source.address());
  });
  return found == m_networks.end() ? nullptr : &*found;
}

// Cheap tests come first, and those that a stranger to the link cannot pass.
std::optional<LanQueryJudge::Reply> LanQueryJudge::judgePacket(const LanPacket& packet, std::size_t players,
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
  // The common allowance is taken last: who is over their own does not use it up.
  TokenBucket& own = m_prefixes.use(AddressPrefix::of(packet.source.address()));
  if (!own.takeToken(kOfAPrefix, now) || !m_all.takeToken(kInAll, now)) {
    ++m_counters.too_often;
    return std::nullopt;
  }
  ++m_counters.answered;
  LanAnswer answer = m_facts;
  answer.nonce = *nonce;
  constexpr std::size_t kMost = std::numeric_limits<std::uint16_t>::max();
  answer.players = static_cast<std::uint16_t>(std::min(players, kMost));
  return Reply{p_network, writeLanAnswer(answer)};
}

void LanQueryJudge::noteUnsent() {
  --m_counters.answered;
  ++m_counters.unsent;
}

}  // namespace naiad
