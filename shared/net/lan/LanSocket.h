// A UDP socket for LAN queries or their answers. It sends with the full hop limit and reports, for each
// received packet, its interface and remaining hop limit.
//
// A server's socket shares its port with the other servers of the machine. No packet passes a router
// (MSG_DONTROUTE; link-local groups).
#pragma once

#include <array>
#include <asio/ip/udp.hpp>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "shared/net/lan/LanMessage.h"
#include "shared/net/lan/LanNetworks.h"

namespace naiad {

struct LanPacket {
  asio::ip::udp::endpoint source;
  unsigned interface = 0;
  int hop_limit = 0;       ///< remaining hop limit; 0: the system did not report it
  bool to_group = false;   ///< sent to the group, not to this machine alone
  std::string_view bytes;  ///< truncated to kLanQuerySize + 1
};

/// Never blocks. Not thread-safe.
class LanSocket {
 public:
  enum class Family { kIPv4, kIPv6 };

  /// Opens a socket that receives queries on the interfaces of joinGroup(). Throws std::system_error.
  static LanSocket forServer(Family family);
  /// Opens a socket, on its own port, that sends queries and receives answers. Throws std::system_error.
  static LanSocket forClient(Family family);
  ~LanSocket();
  LanSocket(LanSocket&& other) noexcept;
  LanSocket& operator=(LanSocket&&) = delete;

  Family family() const { return m_family; }
  int descriptor() const { return m_descriptor; }

  /// Begins to receive queries from this interface. Returns false if the system refuses. Joining again
  /// changes nothing.
  bool joinGroup(unsigned interface);
  /// Returns the next packet; nullopt if none waits, or after eight errors. Its bytes are valid until the
  /// next call.
  std::optional<LanPacket> receivePacket();
  /// Sends a query to the group through the network's interface, from its address. Returns false if that
  /// failed.
  bool sendQuery(const LanNetwork& from, std::string_view bytes);
  /// Sends an answer to a neighbour in this network. Returns false if that failed.
  bool sendAnswer(const LanNetwork& from, const asio::ip::udp::endpoint& to, std::string_view bytes);

 private:
  explicit LanSocket(Family family);
  bool send(const LanNetwork& from, const asio::ip::udp::endpoint& to, std::string_view bytes, int flags);

  Family m_family;
  int m_descriptor = -1;
  std::array<char, kLanQuerySize + 1> m_bytes{};
};

/// Opens the sockets of both families with LanSocket::forServer or forClient. A machine may lack IPv6, so
/// this throws (the last error) only if both fail.
std::vector<LanSocket> openLanSockets(LanSocket (*p_open)(LanSocket::Family family));

}  // namespace naiad
