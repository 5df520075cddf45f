// A copy of a player's object, advanced beyond its last known state. The client draws it; the server computes
// with it what the client draws.
//
// One tick is beginTick(), applyKey() for each input, finishTick(): the order of World::tick(). The copy
// equals the engine's object exactly if only the table, its own motion and the barriers change its path. It
// does not know the game's handlers, swept moves, masks and setMayMoveOut().
#pragma once

#include <cstdint>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/Steering.h"

namespace naiad {

/// The obstacles that block the predicted copy of an object.
class Barriers {
 public:
  virtual ~Barriers() = default;
  /// True if the object is blocked at `to` in the tick that ends as `tick`. `in_update`: true in the movement
  /// phase, at the object's turn; false before it, while the inputs are handled.
  virtual bool isBlocked(df::FixedVector to, std::uint32_t tick, bool in_update) const = 0;
};

class PredictedObject : public SteeringTarget {
 public:
  /// Starts at the end of `known.tick`. Without barriers nothing blocks. `table` and `*p_barriers` must
  /// outlive the copy.
  PredictedObject(const ControlRecord& known, const df::ControlTable& table,
                  const Barriers* p_barriers = nullptr);

  void beginTick();
  void applyKey(df::Keyboard::Key key, df::EventKeyboardAction action);
  void finishTick();

  /// The state after the last finishTick(); its newest_input is unchanged.
  const ControlRecord& now() const { return m_now; }
  /// Returns all positions that the copy moved to, for the view that follows it.
  const std::vector<df::FixedVector>& trail() const { return m_trail; }

  df::FixedVector position() const override { return m_now.position; }
  df::FixedVector velocity() const override { return m_now.velocity; }
  void setVelocity(df::FixedVector velocity) override { m_now.velocity = velocity; }
  void moveTo(df::FixedVector position) override { move(position, false); }

 private:
  void move(df::FixedVector to, bool in_update);

  const df::ControlTable& m_table;
  const Barriers* m_p_barriers;
  ControlRecord m_now;
  std::vector<df::FixedVector> m_trail;
};

/// Ticks after which a state that still changes by itself is sent again.
inline constexpr int kMaxDeadReckoning = 30;

/// Returns the state that a client with only `known` assumes at `tick` (dead reckoning): no keys, no
/// obstacles, no change after kMaxDeadReckoning ticks. A server need not send an equal state.
ControlRecord deadReckon(const ControlRecord& known, const df::ControlTable& table, std::uint32_t tick);

}  // namespace naiad
