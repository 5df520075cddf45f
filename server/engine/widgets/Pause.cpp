#include "engine/widgets/Pause.h"

#include <algorithm>
#include <string>

#include "engine/world/EventPlayer.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

constexpr int kVoteTicks = 300;  // ticks for which a vote counts after the newest one: ten seconds

/// Returns the players that can vote: those whose input the host passes on.
std::vector<std::uint32_t> votersOf(const World& world) {
  const WorldExtras* p_extras = world.findExtras();
  const std::uint32_t only = p_extras != nullptr ? p_extras->input_player : 0;
  std::vector<std::uint32_t> voters;
  for (const Player* p_player : world.views().getPlayers()) {
    if (only == 0 || p_player->getId() == only) voters.push_back(p_player->getId());
  }
  return voters;
}

}  // namespace

Pause::Pause(int init_pause_key) : m_pause_key(init_pause_key) {
  Object::setType(World::current().compat() ? "Pause" : "df-pause");
  Object::setSolidness(SPECTRAL);
  setVisible(false);
  receiveWhilePaused();
  registerInterest(KEYBOARD_EVENT);
  registerInterest(LEAVE_EVENT);
}

Pause::~Pause() {
  if (World* p_world = getWorld()) p_world->setPaused(false);
}

int Pause::eventHandler(const Event* p_e) {
  if (const auto* p_leave = dynamic_cast<const EventLeave*>(p_e)) {
    leave(p_leave->getPlayer());
    return 1;
  }
  const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
  if (p_key == nullptr || p_key->getKeyboardAction() != KEY_PRESSED || p_key->getKey() != m_pause_key)
    return 0;
  vote(p_key->getPlayer());
  return 1;
}

// A key event without a player comes from the game itself and takes effect without a vote.
void Pause::vote(std::uint32_t player) {
  World& world = *getWorld();
  const std::vector<std::uint32_t> voters = votersOf(world);
  if (voters.size() < 2 || player == 0) {
    m_votes.clear();
    return world.setPaused(!world.isPaused());
  }
  if (world.getStepCount() - m_voted_at > kVoteTicks) m_votes.clear();
  std::erase_if(m_votes, [&voters](std::uint32_t voter) {
    return std::find(voters.begin(), voters.end(), voter) == voters.end();
  });
  if (std::find(m_votes.begin(), m_votes.end(), player) != m_votes.end()) return;
  m_votes.push_back(player);
  m_voted_at = world.getStepCount();
  count(voters.size(), true);
}

// The leaving player is still in getPlayers() here.
void Pause::leave(std::uint32_t player) {
  World& world = *getWorld();
  std::erase(m_votes, player);
  std::vector<std::uint32_t> voters = votersOf(world);
  std::erase(voters, player);
  if (world.views().getPlayers().size() <= 1) {
    m_votes.clear();
    world.setPaused(false);
  } else if (!m_votes.empty() && world.getStepCount() - m_voted_at <= kVoteTicks) {
    count(voters.size(), false);
  }
}

// Counts the votes and pauses or continues if they are enough. Shows the count to the players if they are
// enough or `announce` is true.
void Pause::count(std::size_t voters, bool announce) {
  World& world = *getWorld();
  const bool enough = 2 * m_votes.size() > voters;
  if (announce || enough) {
    world.extras().addNote((world.isPaused() ? "resume: " : "pause: ") + std::to_string(m_votes.size()) +
                           " of " + std::to_string(voters));
  }
  if (!enough) return;
  m_votes.clear();
  world.setPaused(!world.isPaused());
}

}  // namespace df
