#include "client/lan/LanBrowser.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

namespace naiad {
namespace {

std::vector<LanSocket> socketsOrNone() {
  try {
    return openLanSockets(&LanSocket::forClient);
  } catch (const std::system_error&) {
    return {};
  }
}

LanNonce newNonce() {
  LanNonce nonce{};
  if (getentropy(nonce.data(), nonce.size()) != 0)
    throw std::system_error(errno, std::generic_category(), "getentropy");
  return nonce;
}

/// True for the first address in each network: machines have many temporary addresses in an IPv6 network.
bool isFirstOf(const LanNetwork& network, const std::vector<LanNetwork>& networks) {
  const auto first = std::find_if(networks.begin(), networks.end(), [&network](const LanNetwork& other) {
    return other.interface == network.interface && other.prefix == network.prefix &&
           other.contains(network.address);
  });
  return &*first == &network;
}

}  // namespace

bool isFromLink(const LanPacket& packet, const std::vector<LanNetwork>& networks) {
  if (packet.hop_limit != kLanHopLimit) return false;
  const asio::ip::address& source = packet.source.address();
  bool by_loopback = false;
  bool is_own = false;
  for (const LanNetwork& network : networks) {
    if (network.interface == packet.interface && network.contains(source)) return true;
    by_loopback = by_loopback || (network.is_loopback && network.interface == packet.interface);
    is_own =
        is_own || (network.prefix > 0 &&
                   LanNetwork{0, "", network.address, network.address.is_v4() ? 32u : 128u}.contains(source));
  }
  return by_loopback && is_own;
}

LanBrowser::LanBrowser() : m_sockets(socketsOrNone()), m_nonce(newNonce()) {}

std::vector<int> LanBrowser::descriptors() const {
  std::vector<int> descriptors;
  for (const LanSocket& socket : m_sockets) descriptors.push_back(socket.descriptor());
  return descriptors;
}

void LanBrowser::update(Time now) {
  if (now < m_next_query) return;
  sendQueries();
  m_next_query = now + (++m_sent == 1 ? kRetryDelay : kInterval);
}

void LanBrowser::restart() {
  m_servers.clear();
  m_nonce = newNonce();  // answers with the old nonce are ignored
  m_sent = 0;
  m_next_query = {};
}

void LanBrowser::sendQueries() {
  m_networks = lanNetworks();
  const std::string query = writeLanQuery(m_nonce);
  for (const LanNetwork& network : m_networks) {
    if (!isFirstOf(network, m_networks)) continue;
    for (LanSocket& socket : m_sockets) {
      const bool same = (socket.family() == LanSocket::Family::kIPv4) == network.address.is_v4();
      if (same) socket.sendQuery(network, query);
    }
  }
}

bool LanBrowser::receiveAnswers() {
  bool changed = false;
  for (LanSocket& socket : m_sockets) {
    for (int i = 0; i < kMaxAnswersPerCall; ++i) {
      const auto packet = socket.receivePacket();
      if (!packet) break;
      changed = handlePacket(*packet) || changed;
    }
  }
  return changed;
}

bool LanBrowser::handlePacket(const LanPacket& packet) {
  if (!isFromLink(packet, m_networks)) return false;
  const auto answer = readLanAnswer(packet.bytes);
  return answer && answer->nonce == m_nonce && m_servers.addAnswer(packet.source, *answer);
}

}  // namespace naiad
