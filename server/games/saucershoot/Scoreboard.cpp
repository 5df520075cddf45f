#include "Scoreboard.h"

#include <algorithm>
#include <set>

#include "EventStep.h"
#include "EventView.h"
#include "Events.h"
#include "Field.h"
#include "GameManager.h"
#include "Player.h"
#include "Points.h"
#include "WorldManager.h"

namespace {

constexpr int kTeamTicks = 90;         // ticks after a hit in which it counts for the team
constexpr int kBiggestTeam = 4;        // maximum factor for the hits of a team
constexpr int kShowTicks = 150;        // ticks for which the best pilots are shown
constexpr int kShowEveryTicks = 1800;  // ticks from one display of the best pilots to the next
constexpr std::size_t kBestCount = 3;

}  // namespace

Scoreboard::Scoreboard() {
  setType("Scoreboard");
  setSolidness(df::SPECTRAL);
  setVisible(false);
  registerInterest(df::STEP_EVENT);
  registerInterest(SHOT_DOWN_EVENT);
  registerInterest(SHIP_LOST_EVENT);
}

int Scoreboard::eventHandler(const df::Event* p_e) {
  if (p_e->getType() == df::STEP_EVENT) {
    step(static_cast<const df::EventStep*>(p_e)->getStepCount());
    return 1;
  }
  if (p_e->getType() == SHOT_DOWN_EVENT) {
    credit(*static_cast<const EventShotDown*>(p_e));
    return 1;
  }
  if (p_e->getType() == SHIP_LOST_EVENT) {
    enter(*static_cast<const EventShipLost*>(p_e));
    return 1;
  }
  return 0;
}

void Scoreboard::step(int tick) {
  std::erase_if(m_last_hit, [tick](const auto& hit) { return hit.second + kTeamTicks < tick; });
  if (tick % kShowEveryTicks == 0) m_show_best = kShowTicks;
  if (m_show_best > 0) --m_show_best;

  const std::string team = teamFactor() < 2 ? "" : "team x" + std::to_string(teamFactor());
  const bool is_title = !WM.objectsOfType("GameStart").isEmpty();
  const std::string best = m_show_best > 0 || is_title ? bestPilots() : "";
  for (df::Player* p_player : WM.getPlayers()) {
    p_player->setText(TEAM_TEXT, df::Vector(fieldWidth() - 10, 0), team, df::YELLOW);
    p_player->setText(BEST_TEXT, df::Vector(1, fieldHeight() - 1), best, df::YELLOW);
  }
}

void Scoreboard::credit(const EventShotDown& shot_down) {
  df::Player* p_player = WM.getPlayer(shot_down.getPlayer());
  if (p_player == nullptr) return;  // the player left while the bullet was flying
  m_last_hit[shot_down.getPlayer()] = GM.getStepCount();
  const int points = shot_down.getPoints() * teamFactor();
  p_player->setScore(p_player->getScore() + points);
  const df::EventView view(POINTS_STRING, points, true);
  WM.onEvent(&view);
}

int Scoreboard::teamFactor() const {
  return std::min(static_cast<int>(m_last_hit.size()), kBiggestTeam);
}

void Scoreboard::enter(const EventShipLost& ship_lost) {
  if (ship_lost.getPoints() == 0) return;
  if (ship_lost.isLast()) m_pilots.add(ship_lost.getName(), ship_lost.getPoints());
  m_show_best = kShowTicks;
}

// Returns the names of the best pilots. Names each once, even if a pilot has several of the best results.
std::string Scoreboard::bestPilots() const {
  std::set<std::string> named;
  std::string text;
  for (const df::HighScore& flight : m_pilots.best(df::HighScores::kMaxRows)) {
    if (named.size() == kBestCount) break;
    if (!named.insert(flight.name).second) continue;
    text += text.empty() ? "Best pilots: " : ", ";
    text += flight.name + " " + std::to_string(flight.points);
  }
  return text;
}
