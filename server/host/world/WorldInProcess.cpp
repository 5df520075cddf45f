#include "host/world/WorldInProcess.h"

#include <utility>

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/StateHash.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace naiad {

WorldInProcess::~WorldInProcess() {
  m_world.input().setLagCompensation(nullptr);
}

std::uint32_t WorldInProcess::addInput(df::InputQueue::Input input) {
  return m_world.input().push(std::move(input));
}

void WorldInProcess::setHeard(std::uint32_t player) {
  m_world.extras().heard_player = player;
}

void WorldInProcess::endGame() {
  m_world.setGameOver();
}

void WorldInProcess::tick(bool watched, bool /*truth*/) {
  m_world.store().setWatched(watched);
  m_world.tick();
  m_state_hash.reset();
  if (std::exchange(m_checked, false)) m_state_hash = df::hashState(m_world);
  reportTick();
}

// The view keeps the number of the last tick that was watched.
std::uint32_t WorldInProcess::nextTick() const {
  return static_cast<std::uint32_t>(m_world.getStepCount()) + 1;
}

const df::WorldView& WorldInProcess::view() const {
  return m_world.picture().view();
}

// A game that does not use lag compensation needs no memory for it.
void WorldInProcess::notePublished(const Publisher& publisher) {
  if (m_world.input().isLookingBack() != m_lag_compensator.has_value()) {
    m_world.input().isLookingBack() ? static_cast<void>(m_lag_compensator.emplace())
                                    : m_lag_compensator.reset();
    m_world.input().setLagCompensation(m_lag_compensator ? &*m_lag_compensator : nullptr);
  }
  if (m_lag_compensator) m_lag_compensator->recordTick(publisher, m_world.picture().view());
}

std::vector<std::uint32_t> WorldInProcess::takeLeavers() {
  return m_world.input().takeLeavers();
}

std::vector<df::AddedScore> WorldInProcess::takeScores() {
  df::WorldExtras* p_extras = m_world.findExtras();
  return p_extras != nullptr ? p_extras->scores.takeAdded() : std::vector<df::AddedScore>();
}

bool WorldInProcess::isGameOver() const {
  return m_world.isGameOver();
}

df::Canvas WorldInProcess::renderPlayer(std::uint32_t player) const {
  return m_world.picture().renderPlayer(player);
}

}  // namespace naiad
