// Hands on what players do (book, Listing 4.91). Keys and mouse come from the host through InputQueue::key()
// and InputQueue::mouse(); Objects get them as EventKeyboard and EventMouse.
#pragma once

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Manager.h"

/// The input manager.
#define IM df::InputManager::getInstance()

namespace df {

class InputManager : public Manager {
 public:
  /// The one there is; IM is short for it. It acts on the current world.
  static InputManager& getInstance();

  /// Send the events of all input that waits. GM.tick() does it, after the step event.
  void getInput() const;

 private:
  InputManager();
};

}  // namespace df
