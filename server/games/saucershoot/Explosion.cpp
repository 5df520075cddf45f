#include "Explosion.h"

#include "EventStep.h"
#include "WorldManager.h"

Explosion::Explosion(df::Vector position, df::Vector velocity) {
  setType("Explosion");
  if (setSprite("explosion") == 0) m_time_to_live = getSprite()->getFrameCount() * getSprite()->getSlowdown();
  setSolidness(df::SPECTRAL);
  setAltitude(1);  // above the stars, below all Objects that a player must see
  setPosition(position);
  setVelocity(velocity);
  registerInterest(df::STEP_EVENT);
}

int Explosion::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::STEP_EVENT) return 0;
  if (--m_time_to_live <= 0) WM.markForDelete(this);
  return 1;
}

void explodeShip(df::Vector position) {
  new Explosion(position);
  for (const double x : {-0.4, 0.4}) {
    for (const double y : {-0.2, 0.2}) new Explosion(position, df::Vector(x, y));
  }
}
