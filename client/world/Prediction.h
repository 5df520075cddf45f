// Predicts the player's own object ahead of the snapshots: where it will be when the keys already sent have
// arrived.
//
// At times the server sends the exact state of the object at the end of a tick, and the newest input that had
// reached the game (ControlRecord). From there run() replays all inputs that the server has not acknowledged,
// through the server's control table, against the solid objects of the replica. Each run starts from the
// newest state, so a misprediction needs no separate correction.
//
// run() should run to the tick in which the server will apply a key pressed now: ahead of the newest snapshot
// by a round trip and a margin for jitter. So a key shows in the next frame, whatever the round trip.
//
// Uses no clock or I/O. Ticks are serial numbers. Not thread-safe. Memory is bounded whatever arrives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/PredictedObject.h"
#include "shared/replica/Replica.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad {

class Prediction {
 public:
  /// Limit on replayed ticks: kMaxDeadReckoning, plus a round trip of two seconds at 30 ticks a second.
  static constexpr std::uint32_t kMaxAhead = 90;
  /// Limit on pending inputs; further ones are not predicted.
  static constexpr std::size_t kMaxInputs = 64;

  struct Counters {
    std::uint64_t confirmed = 0;     ///< exact states with the position predicted for their tick
    std::uint64_t mispredicted = 0;  ///< exact states with another position
    std::uint64_t unpredicted = 0;   ///< inputs beyond kMaxInputs
  };

  /// Sets the controls that the game declared; a table without rows ends the prediction.
  void setTable(df::ControlTable table) { m_table = std::move(table); }
  /// Takes an exact state of the object; ignores it if it is not newer than the last one.
  void applyControl(const ControlRecord& record);
  /// Adds a key input that was sent. Its id must be newer than all before. The prediction assumes that the
  /// server applies it in tick `input.tick`, but not before an earlier input.
  void addInput(Input input);
  /// Forgets everything but the counters, for another world.
  void reset();

  /// Predicts the object's state at the end of `tick`. The replica should be as new as the last exact state.
  void run(const Replica& replica, std::uint32_t tick);

  /// True if the last run() found an object to predict.
  bool isActive() const { return m_active; }
  /// True if `object` is the player's own object, which is predicted.
  bool isOwn(const ObjectState& object) const { return m_active && object.order == m_order; }
  /// Position and velocity of the object at the end of the last run()'s tick.
  df::FixedVector position() const { return m_position; }
  df::FixedVector velocity() const { return m_velocity; }
  /// Returns the corner of the view that follows the object, at the end of the last run()'s tick.
  df::FixedVector viewCorner(const Replica& replica) const;
  /// Returns the number of inputs that no exact state includes yet.
  std::size_t pendingInputs() const { return m_inputs.size(); }
  const Counters& counters() const { return m_counters; }

 private:
  /// The prediction for a tick, stored until its exact state arrives.
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
  std::uint32_t m_from = 0;  ///< tick of the state from which the last run() replayed
  df::FixedVector m_position;
  df::FixedVector m_velocity;
  std::vector<df::FixedVector> m_trail;
};

}  // namespace naiad
