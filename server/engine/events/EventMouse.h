// Sent to interested Objects when a player moves or clicks the mouse (book, Listing 4.88).
#pragma once

#include <cstdint>

#include "Event.h"
#include "Keyboard.h"
#include "Vector.h"

namespace df {

/// Register interest in this to get all players' mice.
inline const EventType MSE_EVENT("df-mouse");
/// Older name of the type.
inline const EventType MOUSE_EVENT("df-mouse");

class EventMouse : public Event {
 public:
  EventMouse() { setType(MSE_EVENT); }

  /// Whether a button went down or is held, or the pointer moved.
  void setMouseAction(EventMouseAction action) { m_action = action; }
  EventMouseAction getMouseAction() const { return m_action; }
  /// The button; UNDEFINED_MOUSE_BUTTON if the action is MOVED.
  void setMouseButton(Mouse::Button button) { m_button = button; }
  Mouse::Button getMouseButton() const { return m_button; }
  /// The cell under the pointer, in world coordinates (whole numbers). It can be compared with positions of
  /// Objects directly, wherever in the world the player's view is.
  void setMousePosition(Vector position) { m_position = position; }
  Vector getMousePosition() const { return m_position; }

  /// Id of the player that used the mouse, for `WM.getPlayer()`; 0 if none did.
  void setPlayer(std::uint32_t player) { m_player = player; }
  std::uint32_t getPlayer() const { return m_player; }

 private:
  EventMouseAction m_action = UNDEFINED_MOUSE_ACTION;
  Mouse::Button m_button = Mouse::UNDEFINED_MOUSE_BUTTON;
  Vector m_position;
  std::uint32_t m_player = 0;
};

}  // namespace df
