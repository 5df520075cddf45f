#include "client/lan/FoundServers.h"

#include <algorithm>
#include <tuple>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

int rankOf(const asio::ip::address& address) {
  if (address.is_loopback()) return 3;
  if (address.is_v4()) return 0;
  return address.to_v6().scope_id() == 0 ? 1 : 2;
}

}  // namespace

bool FoundServer::isPlayable() const {
  return protocol == kProtocolVersion;
}

std::string FoundServer::link() const {
  const auto host = LinkHost::parse(where.text());
  return host ? JoinLink{*host, "", key}.text() : "";
}

bool FoundServers::addAnswer(const asio::ip::udp::endpoint& source, const LanAnswer& answer) {
  const ServerFacts& facts = answer;
  const FoundServer server{facts, {source.address().to_string(), answer.port}, answer.key};
  return addEntry(server, rankOf(source.address()));
}

bool FoundServers::addServer(const FoundServer& server) {
  return addEntry(server, 0);
}

bool FoundServers::addEntry(const FoundServer& server, int rank) {
  const auto known = std::find_if(m_entries.begin(), m_entries.end(),
                                  [&server](const Entry& entry) { return entry.server.key == server.key; });
  if (known != m_entries.end()) {
    const bool same_place = known->server.where.text() == server.where.text();
    if (rank > known->rank || (rank == known->rank && !same_place) || known->server == server) return false;
    *known = {server, rank};
    return true;
  }
  const auto here = std::count_if(m_entries.begin(), m_entries.end(), [&server](const Entry& entry) {
    return entry.server.where.host == server.where.host;
  });
  if (m_entries.size() >= kMax || static_cast<std::size_t>(here) >= kMaxOfAnAddress) return false;
  m_entries.push_back({server, rank});
  return true;
}

std::vector<FoundServer> FoundServers::sorted() const {
  std::vector<FoundServer> servers;
  for (const Entry& entry : m_entries) servers.push_back(entry.server);
  const auto order = [](const FoundServer& server) {
    return std::make_tuple(server.name, server.game, server.key.bytes());
  };
  std::sort(servers.begin(), servers.end(),
            [&order](const FoundServer& a, const FoundServer& b) { return order(a) < order(b); });
  return servers;
}

}  // namespace naiad
