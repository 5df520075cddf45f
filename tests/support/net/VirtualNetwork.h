// Any number of datagram sockets and a bad network between them, within one process and in virtual time.
//
// Deterministic: the same seed, conditions and calls give the same deliveries at the same microseconds.
// Callbacks come only from VirtualClock::advanceTo(). Network and sockets may be destroyed in any order, in
// callbacks too; the clock must outlive them all.
//
// A socket has one address, and the network may give it another one (rebind): for its owner nothing
// happens, as when a NAT forgets a mapping or a phone changes networks. What was under way to the old address
// is lost. So the local address that a sender asks for is ignored.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "shared/net/datagram/DatagramSocket.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {

class VirtualNetwork {
 public:
  /// `conditions` hold between any two sockets, each direction by itself, until something else is set.
  VirtualNetwork(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~VirtualNetwork();

  /// A socket at this address; port 0 takes a free one. Throws std::logic_error if the address is taken. A
  /// socket that has not started or is destroyed receives nothing.
  std::unique_ptr<DatagramSocket> open(const Endpoint& address);

  /// The socket's packets now come from there, and reach it there. Throws std::logic_error if it is taken.
  void rebind(const DatagramSocket& socket, const Endpoint& address);
  /// Nothing gets out of the socket, nothing into it, or both; tried when a packet leaves and arrives.
  void block(const DatagramSocket& socket, bool outgoing, bool incoming);
  /// For packets that leave from now on; between all sockets, or from one to another.
  void setConditions(const LinkConditions& conditions);
  void setConditions(const DatagramSocket& from, const DatagramSocket& to, const LinkConditions& conditions);

  /// A packet with a forged sender. It arrives at the next advance, whatever the conditions.
  void spoof(const Endpoint& from, const Endpoint& to, std::string_view packet);
  /// Be shown every packet that a socket sends, when it leaves, lost or not. Forged ones are not shown.
  using Tap = std::function<void(const Endpoint& from, const Endpoint& to, std::string_view packet)>;
  void setTap(Tap tap);

  /// From one socket to another.
  LinkCounters counters(const DatagramSocket& from, const DatagramSocket& to) const;
  /// Packets to an address without a socket, when they were sent or when they arrived.
  std::uint64_t unroutable() const;

 private:
  class Socket;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
