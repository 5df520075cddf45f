// Applies a control table to an object. Server and client both run these functions.
//
// In each tick: beginControlTick() once, then applyControlKey() for each key in the order the keys came, then
// the world moves all objects by their velocities. Uses only integers and the arguments.
#pragma once

#include "shared/values/ControlTable.h"
#include "shared/values/Fixed.h"

namespace naiad {

/// The steered object: the engine's, or the client's predicted copy.
class SteeringTarget {
 public:
  virtual ~SteeringTarget() = default;
  virtual df::FixedVector position() const = 0;
  /// The change of the position per tick.
  virtual df::FixedVector velocity() const = 0;
  virtual void setVelocity(df::FixedVector velocity) = 0;
  /// Moves to `position` unless something blocks it, like Dragonfly's moveObject(): all or nothing.
  virtual void moveTo(df::FixedVector position) = 0;
};

/// Begins a tick: shortens waits, stops the axes of keys released in the last tick, and ends all drives if
/// the keyboard was silent for too long. Then drives and bounds set the velocity.
void beginControlTick(const df::ControlTable& table, df::ControlState& state, SteeringTarget& object);

/// Applies an action of a key. A drive acts immediately when its key is pressed, and with the next tick when
/// the key is reported as held or released. Returns true if an object is steered and a row is for the key,
/// and also for this action unless the row is a drive.
bool applyControlKey(const df::ControlTable& table, df::ControlState& state, df::Keyboard::Key key,
                     df::EventKeyboardAction action, SteeringTarget& object);

}  // namespace naiad
