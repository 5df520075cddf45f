#include "WorldExtras.h"

#include <utility>

#include "World.h"

namespace df {

void WorldExtras::beginTick() {
  sounds.clear();
  shake.step(random);
}

void WorldExtras::endTick() {
  if (!paused) animations.advance();
}

void WorldExtras::reset() {
  resources.clear();
  settings = {};
  shake = {};
  sounds.clear();
  background = BLACK;
  view_slack = Vector(1.0 / 3, 1.0 / 3);
  paused = false;
  network_said = false;
  random = Random(0xD6A60);
  clock = 0;
}

WorldExtras& World::extras() {
  if (m_p_extras == nullptr) m_p_extras = std::make_unique<WorldExtras>(*this);
  return *m_p_extras;
}

void World::addResourceFolder(std::string folder) {
  extras().resources.addFolder(std::move(folder));
}

void World::setPaused(bool paused) {
  if (paused != isPaused()) extras().paused = paused;
}

bool World::isPaused() const {
  return m_p_extras != nullptr && m_p_extras->paused;
}

void World::noteSound(SoundPlayed sound) {
  constexpr std::size_t kMost = 256;  // more in a tick nobody hears
  std::vector<SoundPlayed>& sounds = extras().sounds;
  if (sounds.size() < kMost) sounds.push_back(std::move(sound));
}

}  // namespace df
