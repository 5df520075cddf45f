// How a player's keys move their Object, declared instead of programmed: Player::setControls().
//
// A game that moves its Object in the handler of EventKeyboard shows a key only after a round trip. One that
// declares its controls lets the client show it in the next frame: the client has the table, moves its copy
// at once, and corrects it by the server's result.
//
//   player.setControls(Controls()
//                          .onKey(Keyboard::UPARROW).step(0, -1).every(3)
//                          .onKey(Keyboard::DOWNARROW).step(0, 1).every(3)
//                          .within(Box(Vector(1, 1), 70, 20)));
//
// The engine does what the table says just before the key's EventKeyboard is sent, which then says
// isHandled(). It moves the Object as the game would: with WM.moveObject() and setVelocity(), collisions,
// out events and all. At most 32 rows; a number that is not finite or out of range spoils the whole table.
#pragma once

#include <optional>

#include "Box.h"
#include "ControlTable.h"
#include "Keyboard.h"

namespace df {

class Controls {
 public:
  /// What is said next happens when `action` is done to `key`.
  Controls& onKey(Keyboard::Key key, EventKeyboardAction action = KEY_PRESSED);
  /// Move by (dx,dy), once, at once: WM.moveObject(). Up to 1024 cells on each axis.
  Controls& step(double dx, double dy);
  /// Set the velocity, in cells per tick; it stays until it is changed.
  Controls& velocity(double vx, double vy);
  /// Likewise of one axis; the other keeps its own.
  Controls& velocityX(double vx);
  Controls& velocityY(double vy);
  /// While the key is down, whatever onKey() said of the action: this velocity on the axes that are not 0;
  /// of keys for the same axis the last one pressed wins. When it goes up, the axis comes to rest with the
  /// next tick. An axis with a drive belongs to the player's keys alone.
  Controls& drive(double vx, double vy);
  /// The last step or velocity and all others of the same `group` (0 to 7) act at most once in so many
  /// ticks (up to 9000).
  Controls& every(int ticks, int group = 0);

  // For the table as a whole.

  /// No key leads the Object's position out of this box, its edges included: a step that would does not
  /// happen, a velocity that would is 0 on that axis.
  Controls& within(const Box& box);
  /// What is driven comes to rest on the next whole cell of the axis, not where it is: a tap is a step.
  Controls& toWholeCells();
  /// Drives are let go when the player has sent no key for so many ticks (up to 9000): for terminals that
  /// lose the moment a key goes up.
  Controls& patience(int ticks);

  /// The table; nothing if a number was not finite or out of range, or there are too many rows.
  std::optional<ControlTable> table() const;

 private:
  Controls& add(ControlEffect effect, bool x, bool y, double vx, double vy);

  ControlTable m_table;
  Keyboard::Key m_key = Keyboard::UNDEFINED_KEY;
  EventKeyboardAction m_action = KEY_PRESSED;
  bool m_spoiled = false;
};

}  // namespace df
