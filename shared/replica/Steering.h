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

/// A tick begins: waits get shorter, keys that went up in the last tick no longer pull, a keyboard that has
/// been silent for too long releases its drives; then the drives and the bounds set the velocity.
void beginControlTick(const df::ControlTable& table, df::ControlState& state, Steered& object);

/// Apply an action of a key. A drive acts immediately when its key is pressed, and with the next tick when
/// the key is reported as held or goes up. Returns whether a row of the table is for the key (and there is an
/// object to steer).
bool applyControlKey(const df::ControlTable& table, df::ControlState& state, df::Keyboard::Key key,
                     df::EventKeyboardAction action, Steered& object);

}  // namespace naiad
