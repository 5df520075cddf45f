#include "Points.h"

#include "EventStep.h"
#include "Events.h"
#include "WorldManager.h"

Points::Points() {
  setType("Points");
  setLocation(df::TOP_CENTER);
  setBorder(false);
  setViewString(POINTS_STRING);
  setColor(df::YELLOW);
  registerInterest(df::STEP_EVENT);
  registerInterest(ROUND_EVENT);
}

int Points::eventHandler(const df::Event* p_e) {
  if (df::ViewObject::eventHandler(p_e)) return 1;
  if (p_e->getType() == df::STEP_EVENT) {
    const bool second = static_cast<const df::EventStep*>(p_e)->getStepCount() % 30 == 0;
    if (m_counting && second) setValue(getValue() + 1);
    return 1;
  }
  if (p_e->getType() == ROUND_EVENT) {
    m_counting = false;  // the points stay visible until the title is shown again
    if (static_cast<const EventRound*>(p_e)->getPart() == EventRound::TITLE) WM.markForDelete(this);
    return 1;
  }
  return 0;
}
