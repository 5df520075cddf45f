// The servers that were found: a bounded list without doubles, in the order in which people read it,
// and the same as text and JSON.
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

/// What a server says of itself, or who lists it says of it: all of it may be wrong. Texts are safe to draw.
struct FoundServer : ServerFacts {
  ServerAddress where;
  ShortKey key = ShortKey::ofBytes({});  ///< that the server must prove when it is joined

  /// Does it speak this program's protocol?
  bool isPlayable() const;
  /// The link that leads to it; empty where no link can: an IPv6 address with a zone.
  std::string link() const;

  friend bool operator==(const FoundServer&, const FoundServer&) = default;
};

class FoundServers {
 public:
  /// Servers in the list, and of those from one address. Who comes when it is full is left out.
  static constexpr std::size_t kMax = 64;
  static constexpr std::size_t kMaxOfAnAddress = 16;

  /// Add what the server at `source` says, or put it in place of what the one with this key said before. Of
  /// the addresses of one server the best stays: IPv4, then IPv6, then IPv6 with a zone, and loopback last.
  /// True if the list is another one now.
  bool addAnswer(const asio::ip::udp::endpoint& source, const LanAnswer& answer);
  /// The same for one that a list on the web names.
  bool addServer(const FoundServer& server);
  /// Forget all.
  void clear() { m_entries.clear(); }

  /// By name, then game, then key.
  std::vector<FoundServer> sorted() const;
  std::size_t size() const { return m_entries.size(); }

 private:
  struct Entry {
    FoundServer server;
    int rank = 0;  ///< of its address; less is better
  };
  bool addEntry(const FoundServer& server, int rank);

  std::vector<Entry> m_entries;
};

/// Reads a list of servers from the web: what dfserver --status-file writes, or an array of that.
///
/// A list comes from strangers: it is read in bounded memory and depth, its texts are made safe, and a server
/// counts only if it has a whole link. Nothing unless `json` is a JSON object or an array of objects (RFC
/// 8259), of UTF-8, at most 8 levels deep. Of an object name, game, players, max_players, password, protocol
/// and link are read; numbers out of range count as the nearest in it, members of another type as missing.
/// Objects without a link that leads somewhere are passed over. The list is cut as FoundServers cuts it.
std::optional<FoundServers> readServerList(std::string_view json);

/// What to do where no server was found: sentences for people.
inline constexpr const char* kNoServersFound[] = {
    "No server answered in this network.",
    "Start one here: dfserver --game NAME. Join one elsewhere: dfclient HOST[:PORT], or its link."};

/// "3/16", and what else is to be known before joining: "password", "full", "version 5".
std::string placesOf(const FoundServer& server);
std::string noteOf(const FoundServer& server);

/// A line for each, in columns, and a head; a sentence if there is none.
std::string serversAsText(const std::vector<FoundServer>& servers);
/// A JSON array of objects (docs/doors.md lists their members), one to a line. ASCII only.
std::string serversAsJson(const std::vector<FoundServer>& servers);

}  // namespace naiad
