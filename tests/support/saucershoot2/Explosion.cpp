#include "Explosion.h"

#include "EventStep.h"
#include "WorldManager.h"

Explosion::Explosion(df::Vector where) {
  setType("Explosion");
  time_to_live = 1;
  if (setSprite("explosion") == 0)
    time_to_live = getAnimation().getSprite()->getFrameCount() * getAnimation().getSprite()->getSlowdown();
  setSolidness(df::SPECTRAL);
  setPosition(where);
  registerInterest(df::STEP_EVENT);
}

int Explosion::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::STEP_EVENT) return 0;
  if (--time_to_live <= 0) WM.markForDelete(this);
  return 1;
}
