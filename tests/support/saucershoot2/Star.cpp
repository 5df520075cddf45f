#include "Star.h"

#include "DisplayManager.h"
#include "EventOut.h"
#include "WorldManager.h"

Star::Star() {
  setType("Star");
  setSolidness(df::SPECTRAL);
  setAltitude(0);
  setVelocity(df::Vector(-1.0 / (rand() % 10 + 2), 0));
  setPosition(df::Vector(rand() % (int)WM.getBoundary().getHorizontal(),
                         rand() % (int)WM.getBoundary().getVertical()));
}

int Star::draw() {
  return DM.drawCh(getPosition(), '.', df::WHITE);
}

int Star::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::OUT_EVENT) {
    out();
    return 1;
  }
  return 0;
}

void Star::out() {
  setPosition(df::Vector(WM.getBoundary().getHorizontal() + rand() % 20,
                         rand() % (int)WM.getBoundary().getVertical()));
  setVelocity(df::Vector(-1.0 / (rand() % 10 + 2), 0));
}
