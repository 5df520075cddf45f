#include "engine/managers/InputManager.h"

#include "engine/world/Started.h"
#include "engine/world/World.h"

namespace df {

InputManager& InputManager::getInstance() {
  static InputManager* p_instance = new InputManager;
  return *p_instance;
}

int InputManager::startUp() {
  World::current().setStarted(kInputStarted, true);
  return 0;
}

void InputManager::shutDown() {
  World::current().setStarted(kInputStarted, false);
}

bool InputManager::isStarted() const {
  return World::current().isStarted(kInputStarted);
}

void InputManager::getInput() const {
  World::current().drainInput();
}

}  // namespace df
