#include "Hangar.h"

#include "EventPlayer.h"
#include "Hero.h"
#include "WorldManager.h"

Hangar::Hangar() {
  setType("Hangar");
  setSolidness(df::SPECTRAL);
  setVisible(false);
  registerInterest(df::JOIN_EVENT);
}

int Hangar::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::JOIN_EVENT) return 0;
  const auto* p_join = static_cast<const df::EventJoin*>(p_e);
  new Hero(*WM.getPlayer(p_join->getPlayer()));
  return 1;
}
