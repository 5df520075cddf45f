// Declares how a player's keys move their Object: Player::setControls().
//
// If a game moves an Object in its handler of EventKeyboard, the player sees a key's effect only after a
// round trip. With declared controls, they see it in the next frame: the client has the table, moves its copy
// of the Object at once, and corrects the copy by the server's result.
//
//   player.setControls(Controls()
//                          .onKey(Keyboard::UPARROW).step(0, -1).every(3)
//                          .onKey(Keyboard::DOWNARROW).step(0, 1).every(3)
//                          .within(Box(Vector(1, 1), 70, 20)));
//
// The engine applies the table just before it sends the key's EventKeyboard, whose isHandled() then tells
// whether the table handled the key. It moves the Object as the game would, with WM.moveObject() and
// setVelocity(), including collisions and out events. At most 32 rows. A number that is not finite or out of
// range makes a table invalid.
#pragma once

#include <optional>

#include "Box.h"
#include "ControlTable.h"
#include "Keyboard.h"

namespace df {

class Controls {
 public:
  /// Selects the key and the action for which the next calls add effects.
  Controls& onKey(Keyboard::Key key, EventKeyboardAction action = KEY_PRESSED);
  /// Moves the Object once by (dx,dy), up to 1024 cells on each axis, with WM.moveObject().
  Controls& step(double dx, double dy);
  /// Sets the Object's velocity, in cells per tick. It stays until something changes it.
  Controls& velocity(double vx, double vy);
  /// Like velocity(), for one axis; the velocity on the other axis does not change.
  Controls& velocityX(double vx);
  Controls& velocityY(double vy);
  /// While the key is down, whatever the action in onKey(), sets the velocity on those axes on which (vx,vy)
  /// is not 0. If several keys drive one axis, the last one pressed wins. When that key goes up, the axis
  /// stops with the next tick. The engine sets a driven axis' velocity in every tick; nothing else should.
  Controls& drive(double vx, double vy);
  /// Limits the step or velocity added last: all steps and velocities of one `group` (0 to 7) together act at
  /// most once in `ticks` ticks (up to 9000).
  Controls& every(int ticks, int group = 0);

  // Settings of the whole table.

  /// Keeps the Object's position inside this box, edges included. A step that would leave the box does not
  /// happen; a velocity that would leave it is set to 0 on that axis.
  Controls& within(const Box& box);
  /// Stops a driven axis at the next whole cell instead of at once, so that a short press is one step.
  Controls& toWholeCells();
  /// Ends drives when the player has sent no key for this many ticks (up to 9000; 0: never), for terminals
  /// that may not report that a key went up.
  Controls& releaseAfter(int ticks);
  [[deprecated("say releaseAfter")]] Controls& patience(int ticks) { return releaseAfter(ticks); }

  /// Returns the table; nullopt if a number was not finite or out of range, a key is unknown, every() was
  /// called before a row or for a drive, or there are too many rows.
  std::optional<ControlTable> table() const;

 private:
  Controls& add(ControlEffect effect, bool x, bool y, double vx, double vy);

  ControlTable m_table;
  Keyboard::Key m_key = Keyboard::UNDEFINED_KEY;
  EventKeyboardAction m_action = KEY_PRESSED;
  bool m_is_invalid = false;
};

}  // namespace df
