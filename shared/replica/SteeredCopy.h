// A copy of the object that a player steers, ahead of its last known state: on the client to draw it, on the
// server to find out what the client draws.
//
// One tick is beginTick(), applyKey() for each input, finishTick(): the order of World::tick(). It equals the
// engine's object to the last bit as long as nothing but the table, its own motion and the barriers change
// its path; handlers of the game, swept moves, masks and setMayMoveOut() are not known here.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/Steering.h"

namespace naiad {

/// What blocks a copy.
class Barriers {
 public:
  virtual ~Barriers() = default;
  /// Would the object be blocked at `to`, in the tick that ends as `tick`? `in_update`: at its turn among
  /// those that move; else before, among the inputs.
  virtual bool block(df::FixedVector to, std::uint32_t tick, bool in_update) const = 0;
};

class SteeredCopy : public Steered {
 public:
  /// As it was at the end of `known.tick`. Without barriers nothing blocks. All must outlive the copy.
  SteeredCopy(const ControlRecord& known, const df::ControlTable& table,
              const Barriers* p_barriers = nullptr);

  void beginTick();
  void applyKey(df::Keyboard::Key key, df::EventKeyboardAction action);
  void finishTick();

  /// The state after the last finishTick(); its newest_input is left to the caller.
  const ControlRecord& now() const { return m_now; }
  /// All positions since the beginning, for the view that follows it.
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
inline constexpr int kMaxCoasting = 30;

/// The state that a client which knows only `known` assumes at `tick`: no keys, no obstacles, and no change
/// after kMaxCoasting ticks (dead reckoning). A server need not send a state that equals it.
ControlRecord coast(const ControlRecord& known, const df::ControlTable& table, std::uint32_t tick);

}  // namespace naiad
