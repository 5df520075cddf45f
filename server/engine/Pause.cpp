#include "Pause.h"

#include "World.h"

namespace df {

Pause::Pause(int init_pause_key) : m_pause_key(init_pause_key) {
  Object::setType("df-pause");
  Object::setSolidness(SPECTRAL);
  setVisible(false);
  registerInterest(KEYBOARD_EVENT);
}

Pause::~Pause() {
  if (World* p_world = getWorld()) p_world->setPaused(false);
}

int Pause::eventHandler(const Event* p_e) {
  const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
  if (p_key == nullptr || p_key->getKeyboardAction() != KEY_PRESSED || p_key->getKey() != m_pause_key)
    return 0;
  World* p_world = getWorld();
  p_world->setPaused(!p_world->isPaused());
  return 1;
}

}  // namespace df
