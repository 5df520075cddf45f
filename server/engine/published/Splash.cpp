#include "engine/published/Splash.h"

#include "engine/managers/WorldManager.h"

namespace df {

Splash::Splash() {
  Object::setSolidness(SPECTRAL);
  setVisible(false);
  registerInterest(STEP_EVENT);
}

int Splash::eventHandler(const Event* p_e) {
  if (p_e->getType() != STEP_EVENT) return 0;
  WM.markForDelete(this);
  return 1;
}

}  // namespace df
