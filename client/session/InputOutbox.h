// What the player did that the game has not heard of yet: numbered, and sent until a snapshot acknowledges
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "shared/replica/UpdateCodec.h"

namespace naiad {

class InputOutbox {
 public:
  /// Inputs that wait, at most; of more only those that let a key go are taken. Below the 64 that a server
  /// lets wait, so that who holds a key through a stall is not thrown out as a flooder afterwards, and below
  /// kMaxUpdateInputs.
  static constexpr std::size_t kMax = 40;

  /// The server has received inputs up to this id: the next ones come after it.
  void goOnAfter(std::uint32_t id);
  /// Is there no room? `urgent`: it lets a key go.
  bool isFull(bool urgent) const { return m_inputs.size() >= (urgent ? kMaxUpdateInputs : kMax); }
  /// Give it the next id, and keep it.
  const Input& add(Input input);
  /// The game has had all up to `id`. The input with just that id, if it was still here.
  std::optional<Input> taken(std::uint32_t id);

  bool isEmpty() const { return m_inputs.empty(); }
  /// For a datagram, which may be lost: all.
  std::vector<Input> all() const { return {m_inputs.begin(), m_inputs.end()}; }
  /// For the stream, which loses nothing: those that have not gone that way yet. They have, then.
  std::vector<Input> takeForStream();
  /// Another stream: nothing has gone that way.
  void restartStream() { m_on_stream = 0; }

 private:
  std::deque<Input> m_inputs;
  std::uint32_t m_next = 1;
  std::size_t m_on_stream = 0;  ///< of m_inputs, the first so many went on the stream
};

}  // namespace naiad
