#include "Spawner.h"

#include <algorithm>

#include "EventStep.h"
#include "Events.h"
#include "Field.h"
#include "Saucer.h"
#include "WorldManager.h"

namespace {

constexpr int kMaxSaucers = 32;
constexpr int kSaucersAtRest = 8;  // number of saucers if there are no players
constexpr int kSaucersPerPilot = 2;
constexpr int kLevelsPerPilot = 12;
constexpr int kTicksPerLevel = 120;
constexpr int kTicksPerWave = 4;  // ticks between two waves: after a nuke the sky fills in seconds, not at
                                  // once
constexpr int kRelief = 2;        // levels subtracted for each lost ship

int pilotCount() {
  return WM.objectsOfType("Hero").getCount();
}

}  // namespace

Spawner::Spawner() {
  setType("Spawner");
  setSolidness(df::SPECTRAL);
  setVisible(false);
  registerInterest(df::STEP_EVENT);
  registerInterest(SHIP_LOST_EVENT);

  for (int i = 0; i < kSaucersAtRest; ++i) {
    auto* p_saucer = new Saucer;
    const double left = fieldWidth() / 3;  // no saucers here: the first ship has some time before it meets
                                           // them
    p_saucer->setPosition(
        df::Vector(left + WM.randomInt(static_cast<int>(fieldWidth() - left)), p_saucer->getPosition().y()));
  }
}

int Spawner::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::STEP_EVENT) {
    step(static_cast<const df::EventStep*>(p_e)->getStepCount());
    return 1;
  }
  if (p_e->getType() == SHIP_LOST_EVENT) {
    m_level = std::max(0, m_level - kRelief);
    return 1;
  }
  return 0;
}

void Spawner::step(int tick) {
  const int pilots = pilotCount();
  if (tick % kTicksPerLevel == 0) ++m_level;
  m_level = std::min(m_level, kLevelsPerPilot * pilots);
  if (tick % kTicksPerWave != 0) return;

  const df::ObjectList saucers = WM.objectsOfType("Saucer");
  const int wanted = std::min(kSaucersAtRest + kSaucersPerPilot * pilots + m_level, kMaxSaucers);
  const int missing = wanted - saucers.getCount();
  const int wave = std::min(missing, 1 + pilots / 2);  // larger for more pilots: they shoot more
  for (int i = 0; i < wave; ++i) new Saucer;
  if (missing < 0) retireOne(saucers);
}

void Spawner::retireOne(const df::ObjectList& saucers) {
  df::ObjectListIterator li(&saucers);
  for (li.first(); !li.isDone(); li.next()) {
    if (li.currentObject()->getPosition().x() < fieldWidth() + 3) continue;
    WM.markForDelete(li.currentObject());
    return;
  }
}
