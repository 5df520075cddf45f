// Two ends and a bad network between them, within one process and in virtual time.
//
// LossyDatagramLink loses, doubles, delays and reorders packets; VirtualStreamLink delays frames the way a
// TCP connection over such a network would. Both are deterministic: the same seed, conditions and calls give
// the same deliveries at the same microseconds. Callbacks come only from VirtualClock::advanceTo().
//
// The two ends of a link are called client and server; the link treats them alike. Link and ends
// may be destroyed in any order, in callbacks too; the clock must outlive them all.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "Channel.h"
#include "VirtualClock.h"

namespace naiad {

enum class LinkEnd { kClient, kServer };

/// The network in one direction. The default is perfect: nothing lost, no delay, no limit.
struct LinkConditions {
  std::chrono::microseconds delay{0};   ///< one way
  std::chrono::microseconds jitter{0};  ///< added to each packet's delay: uniform in 0 … jitter
  bool reorder = true;                  ///< jitter may let packets overtake; false: they queue up behind
  double loss = 0;                      ///< probability, 0 … 1, that a packet vanishes
  double duplicate = 0;                 ///< probability, 0 … 1, that one arrives twice (datagrams only)
  std::uint64_t rate = 0;               ///< bytes of payload per second; 0 = unlimited
  /// Datagrams, with a rate: bytes that may wait for the line; what does not fit is dropped (drop-tail).
  std::size_t queue = 65'536;
  /// Streams: bytes that may be under way unacknowledged; what exceeds it stays unsent with the sender.
  std::size_t window = 65'536;
};

/// What happened in one direction so far. Datagrams: sent + duplicated = delivered + dropped + under way.
struct LinkCounters {
  std::uint64_t sent = 0;        ///< packets or frames given to send()
  std::uint64_t delivered = 0;   ///< handed to the receiving end, second copies included
  std::uint64_t dropped = 0;     ///< lost, no room in the queue, or no receiver. Streams: lost and sent again
  std::uint64_t duplicated = 0;  ///< second copies made
  std::uint64_t reordered =
      0;  ///< delivered after one that was sent later. Streams: held back for an earlier one
};

/// A pair of DatagramChannels.
class LossyDatagramLink {
 public:
  /// The same conditions both ways; setConditions() tells them apart.
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
