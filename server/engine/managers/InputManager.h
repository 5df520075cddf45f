// Passes players' input to Objects (book, Listing 4.91). The host adds keys and mouse actions with
// InputQueue::key() and InputQueue::mouse(); Objects get them as EventKeyboard and EventMouse.
#pragma once

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Manager.h"

/// The input manager.
#define IM df::InputManager::getInstance()

namespace df {

class InputManager : public Manager {
 public:
  /// Returns the only instance; IM is short for it. It acts on the current world.
  static InputManager& getInstance();

  /// Sends the events of all waiting input. GM.tick() calls it, after the step event.
  void getInput() const;

 private:
  InputManager();
};

}  // namespace df
