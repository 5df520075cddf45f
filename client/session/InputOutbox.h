// The player's numbered inputs that the game has not applied, sent until a snapshot acknowledges them.
//
// A server applies 16 inputs a tick, queues 64 and ends the session of a client that sends more. A mouse with
// 1000 reports a second, or text pasted into the game, must not cause that; the outbox limits the inputs.
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
  /// Limit on waiting inputs; beyond it only key releases are admitted. It is less than the 64 that a server
  /// queues, so that a key held during a stall does not count as a flood, and less than kMaxUpdateInputs.
  static constexpr std::size_t kMax = 40;
  /// Rate limit: kBurst inputs at once, and kPerTick inputs per tick in the long run.
  static constexpr double kBurst = 32;
  static constexpr double kPerTick = 12;

  /// Call after the welcome. `id`: id of the newest input that the server has. `tick`: length of a tick.
  void start(std::uint32_t id, std::chrono::microseconds tick);
  /// True if no further input may wait. `urgent`: for a key release.
  bool isFull(bool urgent) const { return m_inputs.size() >= (urgent ? kMaxUpdateInputs : kMax); }
  /// Returns true if one more input may be sent, and counts it against the rate limit. Urgent inputs are
  /// limited only by isFull(): a key whose release is lost would stay down.
  bool admitInput(bool urgent, TokenBucket::Time now);
  /// Stores the input with the next id.
  const Input& add(Input input);
  /// Removes the inputs that the game has applied, those up to `id`. Returns the one with `id`, if stored.
  std::optional<Input> removeUpTo(std::uint32_t id);

  bool isEmpty() const { return m_inputs.empty(); }
  /// Returns all inputs that the game has not confirmed: for a datagram, which may be lost.
  std::vector<Input> all() const { return {m_inputs.begin(), m_inputs.end()}; }
  /// Returns the inputs that the stream, which loses nothing, has not carried yet.
  std::vector<Input> popForStream();
  /// Call for a new stream, which has carried no inputs.
  void restartStream() { m_on_stream = 0; }

 private:
  BucketRate m_rate{.burst = kBurst};
  TokenBucket m_bucket;
  std::deque<Input> m_inputs;
  std::uint32_t m_next = 1;
  std::size_t m_on_stream = 0;  ///< number of m_inputs that the stream has carried
};

}  // namespace naiad
