// Inputs of the player that the game has not applied yet: numbered, and sent until a snapshot acknowledges
// them.
//
// A server applies 16 inputs a tick, queues 64 and ends the session of a client that sends more. A mouse at
// 1000 reports a second or a text pasted into the game must not end it, so the outbox stays below these.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "shared/net/base/TokenBucket.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

class InputOutbox {
 public:
  /// Waiting inputs, at most; beyond it only key releases are admitted. Below the 64 that a server lets wait,
  /// so that a player who holds a key through a stall does not count as a flood, and below kMaxUpdateInputs.
  static constexpr std::size_t kMax = 40;
  /// Inputs that may be sent in a burst, and per tick in the long run.
  static constexpr double kBurst = 32;
  static constexpr double kPerTick = 12;

  /// The server has received inputs up to `id`, and its ticks have this length.
  void start(std::uint32_t id, std::chrono::microseconds tick);
  /// `urgent`: a key release.
  bool isFull(bool urgent) const { return m_inputs.size() >= (urgent ? kMaxUpdateInputs : kMax); }
  /// May one more input be sent? Takes a token of the rate limit if so. An urgent one needs only room: a key
  /// whose release is lost would stay down.
  bool admitInput(bool urgent, TokenBucket::Time now);
  /// Give it the next id, and keep it.
  const Input& add(Input input);
  /// The game has applied all up to `id`. The input with just that id, if it was still here.
  std::optional<Input> removeUpTo(std::uint32_t id);

  bool isEmpty() const { return m_inputs.empty(); }
  /// For a datagram, which may be lost: all.
  std::vector<Input> all() const { return {m_inputs.begin(), m_inputs.end()}; }
  /// For the stream, which loses nothing: those that have not been sent there yet.
  std::vector<Input> takeForStream();
  /// Another stream: nothing has been sent there.
  void restartStream() { m_on_stream = 0; }

 private:
  BucketRate m_rate{.burst = kBurst};
  TokenBucket m_bucket;
  std::deque<Input> m_inputs;
  std::uint32_t m_next = 1;
  std::size_t m_on_stream = 0;  ///< of m_inputs, the first so many went on the stream
};

}  // namespace naiad
