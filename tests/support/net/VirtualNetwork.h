// Any number of datagram sockets on a bad network, within one process and in virtual time.
//
// Deterministic: equal seeds, conditions and calls give equal deliveries at equal microseconds. Callbacks
// come only from VirtualClock::advanceTo(). Network and sockets may be destroyed in any order, in callbacks
// too; the clock must outlive them all.
//
// The network can change a socket's address (rebind) without its owner's knowledge, like a NAT that forgets a
// mapping or a phone that changes networks. Packets under way to the old address are lost. So the local
// address that a sender asks for is ignored.
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
  /// `conditions` apply to each direction between any two sockets until setConditions() changes them.
  VirtualNetwork(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~VirtualNetwork();

  /// Opens a socket at this address; port 0 takes a free one. Throws std::logic_error if the address is
  /// taken. A socket that has not started or is destroyed receives nothing.
  std::unique_ptr<DatagramSocket> open(const Endpoint& address);

  /// Changes the socket's address for sending and receiving. Throws std::logic_error if it is taken.
  void rebind(const DatagramSocket& socket, const Endpoint& address);
  /// Blocks packets from the socket, to it, or both. Checked when a packet leaves and when it arrives.
  void block(const DatagramSocket& socket, bool outgoing, bool incoming);
  /// Sets the conditions of packets that leave from now on: between all sockets, or from one to another.
  void setConditions(const LinkConditions& conditions);
  void setConditions(const DatagramSocket& from, const DatagramSocket& to, const LinkConditions& conditions);

  /// Sends a packet with a forged sender. It arrives at the next advance, whatever the conditions.
  void spoof(const Endpoint& from, const Endpoint& to, std::string_view packet);
  /// A function called with each packet that a socket sends, when it leaves, lost or not, but not with forged
  /// ones.
  using Tap = std::function<void(const Endpoint& from, const Endpoint& to, std::string_view packet)>;
  void setTap(Tap tap);

 private:
  class Socket;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
