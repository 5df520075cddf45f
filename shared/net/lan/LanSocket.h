// A UDP socket for the queries of the local network, or for their answers: it sends with the full hop limit
// and says of each packet by which interface it came and which hop limit it had left.
//
// A server's shares its port with the other servers of the machine. No packet goes through a router
// (MSG_DONTROUTE; groups of the link).
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
  int hop_limit = 0;       ///< what is left of it; 0: the system did not say
  bool to_group = false;   ///< it was sent to the group, not to this machine alone
  std::string_view bytes;  ///< cut to kLanQuerySize + 1
};

/// Never blocks. Thread: one at a time.
class LanSocket {
 public:
  enum class Family { kIPv4, kIPv6 };

  /// Hears queries on the interfaces of joinGroup(). Throws std::system_error, as the other one.
  static LanSocket forServer(Family family);
  /// Sends queries and hears their answers, on a port of its own.
  static LanSocket forClient(Family family);
  ~LanSocket();
  LanSocket(LanSocket&& other) noexcept;
  LanSocket& operator=(LanSocket&&) = delete;

  Family family() const { return m_family; }
  int descriptor() const { return m_descriptor; }

  /// False if the system refuses. Joining again changes nothing.
  bool joinGroup(unsigned interface);
  /// The next packet, if one waits; its bytes are good until the next call.
  std::optional<LanPacket> receivePacket();
  /// To the group, by the network's interface, from its address. False if it could not be sent.
  bool sendQuery(const LanNetwork& from, std::string_view bytes);
  /// To a neighbour in this network.
  bool sendAnswer(const LanNetwork& from, const asio::ip::udp::endpoint& to, std::string_view bytes);

 private:
  explicit LanSocket(Family family);
  bool send(const LanNetwork& from, const asio::ip::udp::endpoint& to, std::string_view bytes, int flags);

  Family m_family;
  int m_descriptor = -1;
  std::array<char, kLanQuerySize + 1> m_bytes{};
};

/// Those that there are of the two families, each by LanSocket::forServer or forClient: a machine may lack
/// IPv6. Throws what the last one threw if there is none.
std::vector<LanSocket> openLanSockets(LanSocket (*p_open)(LanSocket::Family family));

}  // namespace naiad
