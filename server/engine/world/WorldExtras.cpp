#include "engine/world/WorldExtras.h"

#include <algorithm>
#include <utility>

#include "engine/world/World.h"

namespace df {

namespace {

bool isSame(const SoundPlayed& a, const SoundPlayed& b) {
  return a.music == b.music && a.label == b.label;
}

}  // namespace

void WorldExtras::noteSound(SoundPlayed sound) {
  std::erase_if(playing, [&sound](const SoundPlayed& other) { return isSame(sound, other); });
  if (sound.what == SoundPlayed::kPlay && sound.loop) {
    if (playing.size() == kMaxPlaying) playing.erase(playing.begin());
    playing.push_back(sound);
  }
  if (sounds.size() < kMaxSounds) {
    sounds.push_back(std::move(sound));
  } else {
    ++sounds_lost;
  }
}

void WorldExtras::addNote(std::string line) {
  if (notes.size() < kMaxNotes) notes.push_back(std::move(line));
}

bool WorldExtras::isPlaying(const std::string& label, bool music) const {
  return std::any_of(playing.begin(), playing.end(),
                     [&](const SoundPlayed& sound) { return sound.music == music && sound.label == label; });
}

void WorldExtras::beginTick() {
  notes.clear();
  sounds.clear();
  sounds_lost = 0;
  shake.step(random);
  rooms.beginTick();
  scores.beginTick(static_cast<std::uint32_t>(world.getStepCount()));
}

void WorldExtras::endTick() {
  if (!paused) animations.advance();
  scores.endTick();
}

void WorldExtras::reset() {
  resources.clear();
  settings = {};
  shake = {};
  sounds.clear();
  sounds_lost = 0;
  playing.clear();
  notes.clear();
  heard_player = 0;
  background = BLACK;
  view_slack = Vector(1.0 / 3, 1.0 / 3);
  paused = false;
  network_said = false;
  connections = {};
  input_filter = nullptr;
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
  extras().noteSound(std::move(sound));
}

}  // namespace df
