// Declares how a player's keys move their Object: Player::setControls().
//
// A game that moves its Object in the handler of EventKeyboard shows a key's effect only after a round trip.
// With declared controls the client shows it in the next frame: it has the table, moves its copy at once, and
// corrects it by the server's result.
//
//   player.setControls(Controls()
//                          .onKey(Keyboard::UPARROW).step(0, -1).every(3)
//                          .onKey(Keyboard::DOWNARROW).step(0, 1).every(3)
//                          .within(Box(Vector(1, 1), 70, 20)));
//
// The engine applies the table just before it sends the key's EventKeyboard, whose isHandled() then says
// whether it did. It moves the Object as the game would, with WM.moveObject() and setVelocity(), including
// collisions and out events. At most 32 rows; a bad number (not finite, out of range) makes a table invalid.
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
  /// Moves the Object once by (dx,dy) with WM.moveObject(). Up to 1024 cells on each axis.
  Controls& step(double dx, double dy);
  /// Sets the velocity, in cells per tick. It stays until it is changed.
  Controls& velocity(double vx, double vy);
  /// Like velocity(), for one axis; the other keeps its velocity.
  Controls& velocityX(double vx);
  Controls& velocityY(double vy);
  /// Sets this velocity on the axes that are not 0 while the key is down, whatever the action in onKey().
  /// Among keys for one axis the last one pressed wins. When it goes up, the axis stops with the next tick.
  /// The engine sets the velocity of a driven axis in every tick, so nothing else should.
  Controls& drive(double vx, double vy);
  /// Lets the last step or velocity, together with all others of its `group` (0 to 7), act at most once in
  /// this many ticks (up to 9000).
  Controls& every(int ticks, int group = 0);

  // Settings of the whole table.

  /// Keeps the Object's position inside this box, edges included: a step that would leave it does not happen,
  /// and a velocity that would is set to 0 on that axis.
  Controls& within(const Box& box);
  /// Stops a driven axis at the next whole cell instead of at once, so that a tap is a step.
  Controls& toWholeCells();
  /// Releases drives when the player has sent no key for this many ticks (up to 9000; 0: never), for
  /// terminals that may miss a key going up.
  Controls& releaseAfter(int ticks);
  [[deprecated("say releaseAfter")]] Controls& patience(int ticks) { return releaseAfter(ticks); }

  /// Returns the table; nullopt if a number was not finite or out of range, or there are too many rows.
  std::optional<ControlTable> table() const;

 private:
  Controls& add(ControlEffect effect, bool x, bool y, double vx, double vy);

  ControlTable m_table;
  Keyboard::Key m_key = Keyboard::UNDEFINED_KEY;
  EventKeyboardAction m_action = KEY_PRESSED;
  bool m_is_invalid = false;
};

}  // namespace df
