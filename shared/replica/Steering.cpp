#include "shared/replica/Steering.h"

#include <cstdlib>

namespace naiad {

namespace {

using df::ControlAxis;
using df::ControlEffect;
using df::ControlRow;
using df::ControlState;
using df::ControlTable;
using df::Fixed;

struct Axes {
  bool x = false;
  bool y = false;
};

Axes driven(const ControlTable& table) {
  Axes axes;
  for (const ControlRow& row : table.rows) {
    if (row.effect != ControlEffect::kDrive) continue;
    axes.x |= row.x;
    axes.y |= row.y;
  }
  return axes;
}

/// Returns the velocity of an object that is no longer driven, on its way to the next whole cell.
Fixed glide(Fixed position, Fixed velocity) {
  constexpr Fixed kFraction = df::kFixedOne - 1;
  const Fixed passed = position & kFraction;
  if (passed == 0 || velocity == 0) return 0;
  const Fixed rest = velocity > 0 ? df::kFixedOne - passed : -passed;
  return std::abs(rest) < std::abs(velocity) ? rest : velocity;
}

Fixed drive(const ControlTable& table, const ControlAxis& lever, Fixed position, Fixed velocity) {
  if (lever.target_velocity != 0) return lever.target_velocity;
  return table.whole_cells ? glide(position, velocity) : 0;
}

bool isOutside(Fixed position, Fixed low, Fixed extent) {
  return position < low || position > low + extent;
}

bool isOutside(const ControlTable& table, df::FixedVector p) {
  return table.bounded && (isOutside(p.x, table.bounds.corner.x, table.bounds.size.x) ||
                           isOutside(p.y, table.bounds.corner.y, table.bounds.size.y));
}

/// Sets the velocity of the drives. On an axis on which it would leave the bounds, any velocity becomes 0.
void setOff(const ControlTable& table, const ControlState& state, SteeringTarget& object) {
  const Axes axes = driven(table);
  const df::FixedVector at = object.position();
  const df::FixedVector before = object.velocity();
  df::FixedVector v = before;
  if (axes.x) v.x = drive(table, state.x, at.x, v.x);
  if (axes.y) v.y = drive(table, state.y, at.y, v.y);
  if (table.bounded) {
    if (isOutside(at.x + v.x, table.bounds.corner.x, table.bounds.size.x)) v.x = 0;
    if (isOutside(at.y + v.y, table.bounds.corner.y, table.bounds.size.y)) v.y = 0;
  }
  if (v != before) object.setVelocity(v);
}

void target_velocity(ControlAxis& lever, Fixed to, bool down) {
  if (down) {
    lever = {to, false};
  } else if (lever.target_velocity == to) {
    lever.is_released = true;  // from the next tick on, so a key pressed and released in one tick still acts
  }
}

void act(const ControlTable& table, const ControlRow& row, ControlState& state, SteeringTarget& object) {
  if (state.wait[row.group] > 0) return;
  state.wait[row.group] = row.wait;
  if (row.effect == ControlEffect::kStep) {
    const df::FixedVector to = object.position() + row.value;
    if (!isOutside(table, to)) object.moveTo(to);
    return;
  }
  df::FixedVector v = object.velocity();
  if (row.x) v.x = row.value.x;
  if (row.y) v.y = row.value.y;
  object.setVelocity(v);
}

}  // namespace

void beginControlTick(const ControlTable& table, ControlState& state, SteeringTarget& object) {
  for (std::uint16_t& wait : state.wait) wait -= wait > 0 ? 1 : 0;
  for (ControlAxis* lever : {&state.x, &state.y}) {
    if (lever->is_released) *lever = {};
  }
  if (table.patience > 0 && ++state.silence > table.patience) {
    state.x = state.y = {};
    state.silence = 0;
  }
  if (state.steering) setOff(table, state, object);
}

bool applyControlKey(const ControlTable& table, ControlState& state, df::Keyboard::Key key,
                     df::EventKeyboardAction action, SteeringTarget& object) {
  const bool down = action != df::KEY_RELEASED;
  if (down) state.silence = 0;
  bool known = false;
  bool turned = action == df::KEY_PRESSED;
  for (const ControlRow& row : table.rows) {
    if (row.key != key) continue;
    if (row.effect == ControlEffect::kDrive) {
      known = true;
      if (row.x) target_velocity(state.x, row.value.x, down);
      if (row.y) target_velocity(state.y, row.value.y, down);
    } else if (row.action == action) {
      known = true;
      turned |= row.effect == ControlEffect::kVelocity;
      if (state.steering) act(table, row, state, object);
    }
  }
  if (state.steering && turned) setOff(table, state, object);
  return known && state.steering;
}

}  // namespace naiad
