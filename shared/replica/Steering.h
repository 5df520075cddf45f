// What a table of controls does to an object: the one function that server and client run.
//
// In each tick: beginControlTick() once, then applyControlKey() for each key in the order the keys came, then
// the world moves everything by its velocity. Pure integer; nothing is read but the arguments.
#pragma once

#include "shared/values/ControlTable.h"
#include "shared/values/Fixed.h"

namespace naiad {

/// The object that is steered: the engine's, or the client's copy that runs ahead.
class Steered {
 public:
  virtual ~Steered() = default;
  virtual df::FixedVector position() const = 0;
  /// What a tick adds to the position.
  virtual df::FixedVector velocity() const = 0;
  virtual void setVelocity(df::FixedVector velocity) = 0;
  /// Move there unless something blocks it, by the rules of the book's moveObject(): all or nothing.
  virtual void moveTo(df::FixedVector position) = 0;
};

/// A tick begins: waits get shorter, keys that went up in the last tick no longer pull, keyboards that have
/// been silent for too long are let go; then the drives and the bounds set the velocity.
void beginControlTick(const df::ControlTable& table, df::ControlState& state, Steered& object);

/// A key did something. A drive acts at once when its key is pressed; if the key is only reported as still
/// down, or goes up, with the next tick. Return whether a row of the table is for it (and there is an
/// object to steer).
bool applyControlKey(const df::ControlTable& table, df::ControlState& state, df::Keyboard::Key key,
                     df::EventKeyboardAction action, Steered& object);

}  // namespace naiad
