#include "host/world/WorldInProcess.h"

#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/StateHash.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldStore.h"

namespace naiad {

namespace {

void applyInputs(const WorldTurn& turn, df::World& world) {
  for (const df::InputQueue::Input& input : turn.inputs) world.input().push(input);
  if (turn.ends_game) world.setGameOver();
}

}  // namespace

void applyTurn(const WorldTurn& turn, df::World& world) {
  applyInputs(turn, world);
  if (turn.input_player != 0 || world.findExtras() != nullptr) {
    world.extras().input_player = turn.input_player;
  }
  world.store().setWatched(turn.watched);
}

WorldAnswer popAnswer(const WorldTurn& turn, df::World& world) {
  WorldAnswer answer;
  answer.game_over = world.isGameOver();
  answer.leavers = world.input().popLeavers();
  answer.has_view = turn.watched;
  if (df::WorldExtras* p_extras = world.findExtras()) {
    answer.scores = p_extras->scores.popAdded();
    answer.sent = p_extras->rooms.popSent();
  }
  if (turn.checked) answer.state_hash = df::hashState(world);
  if (turn.watched && turn.wants_truth) {
    for (const df::PlayerFacts& player : world.picture().view().players) {
      if (turn.rendered_player != 0 && turn.rendered_player != player.id) continue;
      answer.pictures.push_back({player.id, world.picture().renderPlayer(player.id)});
    }
  }
  return answer;
}

WorldInProcess::~WorldInProcess() {
  m_world.input().setLagCompensation(nullptr);
}

void WorldInProcess::tick(const SentTurn& turn) {
  applyTurn(turn.turn, m_world);
  m_world.tick();
  m_answer = popAnswer(turn.turn, m_world);
  reportTick();
}

// Uses the world's step count, because the view has the number of the last watched tick.
std::uint32_t WorldInProcess::nextTick() const {
  return static_cast<std::uint32_t>(m_world.getStepCount()) + 1;
}

const df::WorldView& WorldInProcess::view() const {
  return m_world.picture().view();
}

// Keeps models only for a game that uses lag compensation; others need no memory for them.
void WorldInProcess::onPublished(const Publisher& publisher) {
  if (m_world.input().isLagCompensated() != m_lag_compensator.has_value()) {
    m_world.input().isLagCompensated() ? static_cast<void>(m_lag_compensator.emplace())
                                       : m_lag_compensator.reset();
    m_world.input().setLagCompensation(m_lag_compensator ? &*m_lag_compensator : nullptr);
  }
  if (m_lag_compensator) m_lag_compensator->recordTick(publisher, m_world.picture().view());
}

void WorldInProcess::close(const WorldTurn& rest) {
  applyInputs(rest, m_world);
}

}  // namespace naiad
