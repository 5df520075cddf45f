#include "Reticle.h"

#include "DisplayManager.h"
#include "EventMouse.h"
#include "WorldManager.h"

Reticle::Reticle() {
  setType("Reticle");
  setSolidness(df::SPECTRAL);
  setAltitude(df::MAX_ALTITUDE);
  registerInterest(df::MSE_EVENT);
  setPosition(df::Vector(WM.getBoundary().getHorizontal() / 2, WM.getBoundary().getVertical() / 2));
}

int Reticle::draw() {
  return DM.drawCh(getPosition(), '+', df::RED);
}

int Reticle::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::MSE_EVENT) return 0;
  const df::EventMouse* p_mouse_event = dynamic_cast<const df::EventMouse*>(p_e);
  if (p_mouse_event->getMouseAction() != df::MOVED) return 0;
  setPosition(p_mouse_event->getMousePosition());
  return 1;
}
