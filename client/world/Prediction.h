// The player's own object, ahead of the snapshots: where it will be when the keys already sent have arrived.
//
// The server sends now and then the exact state of the object at the end of a tick, and which inputs had
// reached the game by then (ControlRecord). From there run() replays all inputs that the server has not yet
// acknowledged, through the same table, against the solid objects of the replica. Each run starts from the
// newest state, so a misprediction needs no separate correction.
//
// The tick to run to is the one in which the server will apply a key that is pressed now: ahead of the newest
// snapshot by a round trip and a margin for jitter. So a key shows in the next frame, whatever the round
// trip.
//
// Pure: no clock, no I/O; ticks are serial numbers. Not thread-safe. Bounded whatever the server sends.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/Replica.h"
#include "shared/replica/SteeredCopy.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

class Prediction {
 public:
  /// Ticks that are replayed at most: kMaxCoasting and a round trip of two seconds.
  static constexpr std::uint32_t kMaxAhead = 90;
  /// Pending inputs, at most; further ones are not predicted.
  static constexpr std::size_t kMaxInputs = 64;

  struct Counters {
    std::uint64_t confirmed = 0;     ///< states equal to the prediction for their tick
    std::uint64_t mispredicted = 0;  ///< states that differ from it
    std::uint64_t unpredicted = 0;   ///< inputs beyond kMaxInputs
  };

  /// The controls that the game declared, as they arrive; one without rows ends the prediction.
  void setTable(df::ControlTable table) { m_table = std::move(table); }
  /// The exact state of the object; one that is older than the last is ignored.
  void applyControl(const ControlRecord& record);
  /// A key input as it was sent: its id is newer than all before, and the server should apply it in the tick
  /// that ends as `input.tick`.
  void addInput(Input input);
  /// Forget everything but the counters: another session.
  void reset();

  /// Predict the object's state at the end of `tick`. The replica should be as new as the last state.
  void run(const Replica& replica, std::uint32_t tick);

  /// Did the last run() find an object to predict?
  bool isActive() const { return m_active; }
  /// Is this the predicted object?
  bool isOwn(const ObjectState& object) const { return m_active && object.order == m_order; }
  /// Where it is at the end of the last run()'s tick, and with what velocity it goes on.
  df::FixedVector position() const { return m_position; }
  df::FixedVector velocity() const { return m_velocity; }
  /// Where the view that follows it is then.
  df::FixedVector viewCorner(const Replica& replica) const;
  /// Inputs that no exact state includes yet.
  std::size_t pendingInputs() const { return m_inputs.size(); }
  const Counters& counters() const { return m_counters; }

 private:
  /// What was predicted for a tick, kept until its exact state arrives.
  struct Guess {
    bool made = false;
    std::uint32_t tick = 0;
    df::FixedVector position;
  };
  static constexpr std::size_t kGuesses = 128;

  void replay(const Replica& replica, const ObjectState& own, std::uint32_t tick);
  df::FixedVector reach(std::uint32_t ticks) const;
  Guess& guess(std::uint32_t tick) { return m_guesses[tick % kGuesses]; }

  df::ControlTable m_table;
  std::optional<ControlRecord> m_known;
  std::deque<Input> m_inputs;
  std::array<Guess, kGuesses> m_guesses{};
  Counters m_counters;
  bool m_active = false;
  std::uint64_t m_order = 0;
  std::uint32_t m_from = 0;  ///< the tick that the last replay began at
  df::FixedVector m_position;
  df::FixedVector m_velocity;
  std::vector<df::FixedVector> m_trail;
};

}  // namespace naiad
