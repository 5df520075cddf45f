// A host of rooms that have names: what it gives each of them.
#include <utility>

#include "host/loop/Host.h"

namespace naiad {

void Host::setRooms(std::vector<NamedRoom> rooms) {
  std::vector<RoomPlan> plans;
  for (NamedRoom& room : rooms) {
    RoomPlan& plan = plans.emplace_back(std::move(room.plan));
    plan.new_world = [this, new_world = std::move(room.new_world)] { return new_world(m_io); };
    plan.p_scores = &scoresOf(plan.game);
    m_admission.reservePlayers(plan.highest_player);
  }
  m_rooms.setNamed(std::move(plans));
}

ScoreKeeper& Host::scoresOf(const std::string& game) {
  if (game == m_admission.game()) return m_scores;
  auto& p_scores = m_room_scores[game];
  if (p_scores == nullptr) {
    p_scores = std::make_unique<ScoreKeeper>(m_options.state, game);
    p_scores->setObserver([this, game](const ScoreRow& row) { m_fleet.noteScore(row, game); });
  }
  return *p_scores;
}

}  // namespace naiad
