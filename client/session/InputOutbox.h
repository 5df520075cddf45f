// Inputs of the player that the game has not applied yet: numbered, and sent until a snapshot acknowledges
// them.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "client/session/InputBudget.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

class InputOutbox {
 public:
  /// Waiting inputs, at most; beyond it only key releases are admitted. Below the 64 that a server lets wait,
  /// so that a player who holds a key through a stall is not taken for a flooder, and below kMaxUpdateInputs.
  static constexpr std::size_t kMax = 40;

  /// The server has received inputs up to `id`, and its ticks have this length.
  void start(std::uint32_t id, std::chrono::microseconds tick);
  /// `urgent`: a key release.
  bool isFull(bool urgent) const { return m_inputs.size() >= (urgent ? kMaxUpdateInputs : kMax); }
  /// Is there room for one more input, and budget? Spends the budget if so.
  bool admitInput(bool urgent, InputBudget::Time now);
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
  InputBudget m_budget;
  std::deque<Input> m_inputs;
  std::uint32_t m_next = 1;
  std::size_t m_on_stream = 0;  ///< of m_inputs, the first so many went on the stream
};

}  // namespace naiad
