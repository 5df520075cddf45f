// A bad network between two ends, within one process and in virtual time.
//
// LossyDatagramLink loses, duplicates, delays and reorders packets; VirtualStreamLink delays frames like a
// TCP connection over such a network. Both are deterministic: equal seeds, conditions and calls give equal
// deliveries at equal microseconds. Callbacks come only from VirtualClock::advanceTo().
//
// The two ends of a link are called client and server but behave alike. Link and ends may be destroyed in any
// order, in callbacks too; the clock must outlive them all.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "shared/net/base/Channel.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {

enum class LinkEnd { kClient, kServer };

/// A pair of DatagramChannels.
class LossyDatagramLink {
 public:
  /// Both directions start with `conditions`; setConditions() changes one.
  LossyDatagramLink(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~LossyDatagramLink();

  /// Hands over one end. Throws std::logic_error if it was taken before. An end that is not taken, not
  /// started or destroyed receives nothing: packets to it count as dropped when they arrive. send() throws
  /// std::length_error above 1200 bytes.
  std::unique_ptr<DatagramChannel> takeEnd(LinkEnd end);

  /// Sets the conditions of packets sent from now on, not of those under way.
  void setConditions(LinkEnd from, const LinkConditions& conditions);
  const LinkCounters& counters(LinkEnd from) const;

 private:
  class End;
  struct State;
  std::shared_ptr<State> state_;
};

/// A pair of ReliableChannels.
///
/// The model: a frame leaves when line (rate) and window allow. Each transmission is lost with the combined
/// probability of its segments (1448 bytes each); then it is retransmitted after max(200 ms, 2 × (delay there
/// + delay back)), doubled for each loss in a row up to 10 s, and later frames wait for it at the receiver.
/// Frames arrive whole and in order. An acknowledgement is never lost. It frees the window after the delay
/// back, once the receiver has been handed the frame. So `loss = 1` for a while is an outage that the stream
/// survives. unsentBytes() counts frames that have not left: waiting for the window, or not wholly on the
/// line.
///
/// Ends behave as TcpChannel.h describes: limits, sending cap (1 MiB), close() and reasons. Frames that
/// arrive before start() wait for it. exportSecret() gives both ends equal bytes, made from the seed.
class VirtualStreamLink {
 public:
  VirtualStreamLink(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~VirtualStreamLink();

  /// Hands over one end, whose peer has this address. Throws std::logic_error if it was taken before.
  std::unique_ptr<ReliableChannel> takeEnd(LinkEnd end, const std::string& peer = "virtual");

  /// Sets the conditions of frames that leave, and of losses that happen, from now on.
  void setConditions(LinkEnd from, const LinkConditions& conditions);

  /// Breaks the connection: both ends are closed with kError at the next advance.
  void breakConnection();

 private:
  class Channel;
  struct Side;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
