#include "Star.h"

#include "DisplayManager.h"
#include "EventOut.h"
#include "Field.h"
#include "WorldManager.h"

Star::Star() : m_near(WM.randomInt(3) == 0) {
  setType("Star");
  setSolidness(df::SPECTRAL);
  setAltitude(0);
  setStaticLook();

  const int row = WM.randomInt(DM.getVertical());  // drawn first: compilers evaluate arguments in any order
  setPosition(df::Vector(WM.randomInt(DM.getHorizontal()), row));
  const double speed = m_near ? 0.15 : 0.05;
  setVelocity(df::Vector(-speed - 0.01 * WM.randomInt(5), 0));
}

int Star::eventHandler(const df::Event* p_e) {
  if (p_e->getType() != df::OUT_EVENT) return 0;
  // A star that leaves the screen on the left enters again on the right, in a random row.
  setPosition(df::Vector(fieldWidth(), WM.randomInt(DM.getVertical())));
  return 1;
}

int Star::draw() {
  return m_near ? DM.drawCh(getPosition(), '.', df::WHITE) : DM.drawCh(getPosition(), '.', df::BLUE);
}
