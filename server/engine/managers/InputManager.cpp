#include "engine/managers/InputManager.h"

#include "engine/world/InputQueue.h"
#include "engine/world/Started.h"
#include "engine/world/World.h"

namespace df {

InputManager::InputManager() : Manager("InputManager", kInputStarted) {}

InputManager& InputManager::getInstance() {
  static InputManager* p_instance = new InputManager;
  return *p_instance;
}

void InputManager::getInput() const {
  World::current().input().drain();
}

}  // namespace df
