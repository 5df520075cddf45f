// Servers found in the local network or on the web: bounded, without duplicates, printable as text and JSON.
#pragma once

#include <asio/ip/address.hpp>
#include <asio/ip/udp.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/trust/ServerAddress.h"
#include "shared/net/lan/LanMessage.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// A server, as it describes itself or as a list does, so all members may be wrong. Texts are safe to draw.
struct DiscoveredServer : ServerInfo {
  ServerAddress address;
  ShortKey key = ShortKey::ofBytes({});  ///< key that the server must prove to joining clients

  /// True if the server speaks this program's version of the protocol.
  bool isPlayable() const;
  /// Returns the link to the server; empty for IPv6 addresses with a zone, which links cannot express.
  std::string link() const;

  friend bool operator==(const DiscoveredServer&, const DiscoveredServer&) = default;
};

class DiscoveredServers {
 public:
  /// Limits on servers, in total and per address; further servers are ignored.
  static constexpr std::size_t kMax = 64;
  static constexpr std::size_t kMaxPerAddress = 16;

  /// Adds the server that answered from `source`, or replaces the entry with its key unless that entry has
  /// another address that is as good or better. From best to worst: IPv4, IPv6, IPv6 with a zone, loopback.
  /// Returns true if the list changed.
  bool addAnswer(const asio::ip::udp::endpoint& source, const LanAnswer& answer);
  /// Like addAnswer(), for a server from a list on the web.
  bool addServer(const DiscoveredServer& server);
  void clear() { m_servers.clear(); }

  /// Returns the servers sorted by name, then game, then key.
  std::vector<DiscoveredServer> sorted() const;
  std::size_t size() const { return m_servers.size(); }

 private:
  struct ListedServer {
    DiscoveredServer server;
    int rank = 0;  ///< preference of its address; lower is better
  };
  bool addListed(const DiscoveredServer& server, int rank);

  std::vector<ListedServer> m_servers;
};

/// Parses a list of servers from the web: an object as dfserver --status-file writes it, or an array of them.
///
/// Lists come from strangers, so memory and nesting depth are bounded and texts are made safe. Nullopt unless
/// `json` is a JSON object or an array of objects (RFC 8259), in UTF-8, at most 8 levels deep. Reads the
/// members name, game, players, max_players, password, protocol and link. Numbers are clamped to 16 bits;
/// members of another type count as empty, 0 or false, and so do missing ones, except that without `protocol`
/// the server counts as playable. Objects without a valid link to a server, or with a link to a room, are
/// skipped, and so are servers beyond the limits of DiscoveredServers.
std::optional<DiscoveredServers> readServerList(std::string_view json);

/// Message for people if no server was found: what to do.
inline constexpr const char* kNoServersFound[] = {
    "No server answered in this network.",
    "Start one here: dfserver --game NAME. Join one elsewhere: dfclient HOST[:PORT], or its link."};

/// occupancyText() returns players and places, "3/16". restrictionsText() returns "version 5" if the server
/// speaks another protocol version, else "full", "password" or "".
std::string occupancyText(const DiscoveredServer& server);
std::string restrictionsText(const DiscoveredServer& server);

/// Returns a table with a header and one line per server, or kNoServersFound without servers.
std::string serversAsText(const std::vector<DiscoveredServer>& servers);
/// Returns a JSON array of objects (docs/doors.md lists their members), one per line. ASCII only.
std::string serversAsJson(const std::vector<DiscoveredServer>& servers);

}  // namespace naiad
