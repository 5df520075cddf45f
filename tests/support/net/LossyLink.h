// Two ends and a bad network between them, within one process and in virtual time.
//
// LossyDatagramLink loses, doubles, delays and reorders packets; VirtualStreamLink delays frames the way a
// TCP connection over such a network would. Both are deterministic: the same seed, conditions and calls give
// the same deliveries at the same microseconds. Callbacks come only from VirtualClock::advanceTo().
//
// The two ends of a link are called client and server; the link treats them alike. Link and ends
// may be destroyed in any order, in callbacks too; the clock must outlive them all.
#pragma once

#include <cstdint>
#include <memory>

#include "shared/net/base/Channel.h"
#include "tests/support/net/LinkConditions.h"
#include "tests/support/net/VirtualClock.h"

namespace naiad {

enum class LinkEnd { kClient, kServer };

/// A pair of DatagramChannels.
class LossyDatagramLink {
 public:
  /// The same conditions in both directions; setConditions() sets each.
  LossyDatagramLink(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~LossyDatagramLink();

  /// One end, to own. Throws std::logic_error if it was taken already. An end that was not taken, not
  /// started or is destroyed receives nothing: packets to it are counted as dropped when they arrive.
  /// send() throws std::length_error above 1200 bytes.
  std::unique_ptr<DatagramChannel> takeEnd(LinkEnd end);

  /// From now on; packets under way are not affected.
  void setConditions(LinkEnd from, const LinkConditions& conditions);
  const LinkCounters& counters(LinkEnd from) const;

 private:
  class End;
  struct State;
  std::shared_ptr<State> state_;
};

/// A pair of ReliableChannels.
///
/// The model: a frame leaves when line (rate) and window allow. Each transmission of it is lost with the
/// probability of its segments (1448 bytes each) together; then it is sent again after
/// max(200 ms, 2 × (delay there + delay back)), doubled for each loss in a row up to 10 s, and later frames
/// wait for it at the receiver. Frames arrive whole and in order. An acknowledgement, never lost, frees the
/// window after the delay back, once the receiver has been handed the frame. So `loss = 1` for a while is an
/// outage that the stream survives. unsentBytes() counts frames that have not left: waiting for the window,
/// or not wholly on the line.
///
/// Ends behave as TcpChannel.h describes: limits, sending cap (1 MiB), close() and reasons. Frames that
/// arrive before start() wait for it. exportSecret() gives both ends the same bytes, made from the seed.
class VirtualStreamLink {
 public:
  VirtualStreamLink(VirtualClock& clock, const LinkConditions& conditions, std::uint64_t seed);
  ~VirtualStreamLink();

  /// One end, to own. Throws std::logic_error if it was taken already.
  std::unique_ptr<ReliableChannel> takeEnd(LinkEnd end);

  /// From now on, for frames that leave and for losses that are still to happen.
  void setConditions(LinkEnd from, const LinkConditions& conditions);
  const LinkCounters& counters(LinkEnd from) const;

  /// The connection dies: both ends are closed with kError at the next advance.
  void breakConnection();

 private:
  class Channel;
  struct Side;
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace naiad
