#include "Round.h"

#include "EventStep.h"
#include "GameOver.h"
#include "GameStart.h"
#include "Hero.h"
#include "Points.h"
#include "WorldManager.h"

Round::Round() {
  setType("Round");
  setSolidness(df::SPECTRAL);
  setVisible(false);
  registerInterest(df::STEP_EVENT);
  registerInterest(df::JOIN_EVENT);
  registerInterest(ROUND_EVENT);
  new GameStart;
}

int Round::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::STEP_EVENT) {
    step();
    return 1;
  }
  if (p_e->getType() == df::JOIN_EVENT) {
    const auto* p_join = static_cast<const df::EventJoin*>(p_e);
    if (m_part == EventRound::FLYING) new Hero(*WM.getPlayer(p_join->getPlayer()));
    return 1;
  }
  if (p_e->getType() == ROUND_EVENT) {
    enter(static_cast<const EventRound*>(p_e)->getPart());
    return 1;
  }
  return 0;
}

void Round::enter(EventRound::Part part) {
  m_part = part;
  if (part == EventRound::TITLE) new GameStart;
  if (part == EventRound::OVER) new GameOver;
  if (part != EventRound::FLYING) return;
  new Points;
  for (df::Player* p_player : WM.getPlayers()) new Hero(*p_player);
}

void Round::step() {
  if (m_part != EventRound::FLYING) return;
  const df::ObjectList heroes = WM.objectsOfType("Hero");
  for (int i = 0; i < heroes.getCount(); ++i) {
    if (!static_cast<const Hero*>(heroes[i])->isSpent()) return;
  }
  // If there are no players, the title is shown again at once.
  const EventRound end(heroes.isEmpty() ? EventRound::TITLE : EventRound::OVER);
  WM.onEvent(&end);
}
