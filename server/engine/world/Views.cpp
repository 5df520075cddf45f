#include "engine/world/Views.h"

#include <algorithm>
#include <utility>

#include "engine/world/Object.h"
#include "engine/world/Settings.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "shared/replica/ViewFollow.h"

namespace df {

void Views::reset() {
  m_players.clear();
  m_followers.clear();
  m_followers_known = false;
  m_width = WINDOW_HORIZONTAL_CHARS_DEFAULT;
  m_height = WINDOW_VERTICAL_CHARS_DEFAULT;
  m_boundary = {{}, size()};
  m_boundary_set = false;
  m_corner = {};
  m_followed = {};
}

int Views::setBoundary(const Box& box) {
  const auto boundary = toFixed(box);
  if (!boundary) return m_log.refuse("WorldManager", "setBoundary");
  m_boundary = *boundary;
  m_boundary_set = true;
  clampAll();
  return 0;
}

int Views::setWindow(int width, int height) {
  if (width < 20 || width > 400 || height < 10 || height > 150) return -1;
  m_width = width;
  m_height = height;
  if (!m_boundary_set) m_boundary = {{}, size()};
  clampAll();
  return 0;
}

void Views::clampAll() {
  setCorner(nullptr, m_corner);
  for (const auto& [id, p_player] : m_players) setCorner(p_player.get(), cornerOf(p_player.get()));
}

Player* Views::addPlayer(std::uint32_t id, const std::string& name, Color color) {
  auto p_player = std::make_unique<Player>(*this, id, name, color);
  p_player->m_view_corner = m_corner;
  return (m_players[id] = std::move(p_player)).get();
}

void Views::removePlayer(std::uint32_t id) {
  m_players.erase(id);
  m_followers_known = false;
}

Player* Views::player(std::uint32_t id) const {
  const auto it = m_players.find(id);
  return it == m_players.end() ? nullptr : it->second.get();
}

std::vector<Player*> Views::getPlayers() const {
  std::vector<Player*> players;
  for (const auto& [id, p_player] : m_players) players.push_back(p_player.get());
  return players;
}

int Views::refuse(const char* what) {
  return m_log.refuse("Player", what);
}

FixedVector Views::cornerOf(const Player* p_player) const {
  return p_player != nullptr && p_player->m_has_view ? p_player->m_view_corner : m_corner;
}

Box Views::viewOf(const Player* p_player) const {
  return {Vector::fromFixed(cornerOf(p_player)), static_cast<double>(m_width), static_cast<double>(m_height)};
}

void Views::setCorner(Player* p_player, FixedVector corner) {
  const FixedVector clamped = naiad::clampView({corner, size(), m_boundary}, corner);
  if (p_player != nullptr && p_player->m_has_view) {
    p_player->m_view_corner = clamped;
    return;
  }
  m_corner = clamped;
  for (const auto& [id, p_sharing] : m_players) {
    if (!p_sharing->m_has_view) p_sharing->m_view_corner = clamped;
  }
}

void Views::centre(Player* p_player, FixedVector position) {
  setCorner(p_player, {position.x - size().x / 2, position.y - size().y / 2});
}

int Views::follow(Player* p_player, Object* p_o) {
  ObjectKey key;
  if (p_o != nullptr) {
    if (p_o->m_p_store != &m_store || !m_store.has(p_o->m_slot, WorldStore::kInWorld)) return -1;
    key = p_o->key();
    m_store.set(key.slot, WorldStore::kFollowed, true);
  }
  const bool own = p_player != nullptr && p_player->m_has_view;
  (own ? p_player->m_followed : m_followed) = key;
  m_followers_known = false;
  if (p_o != nullptr) centre(p_player, m_store.position(key.slot));
  return 0;
}

int Views::setObject(Player& player, Object* p_o) {
  if (p_o == nullptr) {
    player.m_object = {};
    player.m_followed = {};
    m_followers_known = false;
    return 0;
  }
  const bool had_view = std::exchange(player.m_has_view, true);
  if (follow(&player, p_o) == 0) {
    player.m_object = player.m_followed;
    return 0;
  }
  player.m_has_view = had_view;
  return -1;
}

void Views::indexFollowers() {
  m_followers_known = true;
  m_followers.clear();
  for (const auto& [id, p_player] : m_players) {
    if (p_player->m_followed.generation != 0)
      m_followers.emplace_back(p_player->m_followed.slot, p_player.get());
  }
  std::stable_sort(m_followers.begin(), m_followers.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

void Views::moved(ObjectKey key, FixedVector position) {
  if (m_followed == key) setCorner(nullptr, naiad::followView({m_corner, size(), m_boundary}, position));
  if (!m_followers_known) indexFollowers();
  auto follower = std::lower_bound(m_followers.begin(), m_followers.end(), key.slot,
                                   [](const auto& entry, std::uint32_t slot) { return entry.first < slot; });
  for (; follower != m_followers.end() && follower->first == key.slot; ++follower) {
    Player& player = *follower->second;
    if (!player.m_has_view || player.m_followed != key) continue;
    player.m_view_corner = naiad::followView({player.m_view_corner, size(), m_boundary}, position);
  }
}

ObjectKey Views::followed(const Player* p_player) const {
  const ObjectKey key = p_player != nullptr && p_player->m_has_view ? p_player->m_followed : m_followed;
  return m_store.find(key) != nullptr ? key : ObjectKey{};
}

ViewCover Views::cover() const {
  std::vector<FixedVector> corners;
  const auto add = [&](FixedVector corner) {
    corners.push_back({fromCells(cellOf(corner.x)), fromCells(cellOf(corner.y))});
  };
  add(m_corner);
  for (const auto& [id, p_player] : m_players) {
    if (p_player->m_has_view) add(p_player->m_view_corner);
  }
  return {corners, size()};
}

}  // namespace df
