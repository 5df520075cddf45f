// A copy of what a player steers, that runs ahead of what is known of it: on the client to draw it, on the
// server to find out what the client draws.
//
// One tick is begin(), key() for each input, finish(): the order of World::tick(). It equals the engine's
// object to the last bit as long as nothing but the table, its own motion and the barriers change its path;
// handlers of the game, swept moves, masks and setMayMoveOut() are not known here.
#pragma once

#include <cstdint>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/Steering.h"

namespace naiad {

/// What stands in the way of a copy.
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

  void begin();
  void key(df::Keyboard::Key key, df::EventKeyboardAction action);
  void finish();

  /// The state after the last finish(); its newest_input is the caller's business.
  const ControlRecord& now() const { return m_now; }
  /// All places it was put since the beginning, for the view that follows it.
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

/// What a client that knows `known` and hears no more takes for true at `tick`, where nothing is in the way;
/// after kMaxCoasting ticks: that nothing changes any more. A server need not send a state that equals it.
ControlRecord coast(const ControlRecord& known, const df::ControlTable& table, std::uint32_t tick);

}  // namespace naiad
