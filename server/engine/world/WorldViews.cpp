// The part of World about boundary, views and players.

#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"

namespace df {

int World::setBoundary(Box boundary) {
  if (m_views->setBoundary(boundary) == 0) return 0;
  refuse("WorldManager", "setBoundary");
  return -1;
}

Box World::getBoundary() const {
  return fromFixed(m_views->boundary());
}

int World::setWindow(int width, int height) {
  return m_views->setWindow(width, height);
}

int World::getWindowWidth() const {
  return m_views->width();
}

int World::getWindowHeight() const {
  return m_views->height();
}

Box World::getView() const {
  const Vector corner = Vector::fromFixed(m_views->cornerOf(getPlayer(m_input_player)));
  return {corner, static_cast<double>(m_views->width()), static_cast<double>(m_views->height())};
}

int World::setView(Box view) {
  const auto corner = toFixed(view.getCorner());
  if (!corner) {
    refuse("WorldManager", "setView");
    return -1;
  }
  m_views->setCorner(getPlayer(m_input_player), *corner);
  return 0;
}

int World::setViewPosition(Vector centre) {
  const auto position = toFixed(centre);
  if (!position) {
    refuse("WorldManager", "setViewPosition");
    return -1;
  }
  m_views->centre(getPlayer(m_input_player), *position);
  return 0;
}

int World::setViewFollowing(Object* p_o) {
  return m_views->follow(getPlayer(m_input_player), p_o);
}

Object* World::getViewFollowing() const {
  return find(m_views->followed(getPlayer(m_input_player)));
}

std::vector<Player*> World::getPlayers() const {
  std::vector<Player*> players;
  for (const auto& [id, p_player] : m_views->players()) players.push_back(p_player.get());
  return players;
}

Player* World::getPlayer(std::uint32_t id) const {
  return m_views->player(id);
}

}  // namespace df
