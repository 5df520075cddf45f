#include "engine/world/WorldExtras.h"

#include <algorithm>
#include <utility>

#include "engine/world/ObjectExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

bool isSame(const SoundPlayed& a, const SoundPlayed& b) {
  return a.music == b.music && a.label == b.label;
}

}  // namespace

Animations::~Animations() {
  for (const Entry& entry : m_entries) entry.p_extras->animated = ObjectExtras::kNowhere;
}

void Animations::add(std::uint32_t slot, ObjectExtras& extras) {
  if (extras.animated != ObjectExtras::kNowhere) return;
  extras.animated = m_entries.size();
  m_entries.push_back({slot, &extras});
}

void Animations::remove(ObjectExtras& extras) {
  if (extras.animated == ObjectExtras::kNowhere) return;
  m_entries[extras.animated] = m_entries.back();
  m_entries.back().p_extras->animated = extras.animated;
  m_entries.pop_back();
  extras.animated = ObjectExtras::kNowhere;
}

// The order does not matter, because the frames of Objects are independent of each other.
void Animations::advance() {
  constexpr std::uint32_t kShown = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kVisible;
  for (const auto& [slot, p_extras] : m_entries) {
    if ((m_store.flags(slot) & kShown) != kShown) continue;
    if (p_extras->animation.advance()) m_store.set(slot, WorldStore::kLookCached, false);
  }
}

void WorldExtras::recordSound(SoundPlayed sound) {
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

void WorldExtras::beginTick(int step_count) {
  notes.clear();
  sounds.clear();
  sounds_lost = 0;
  shake.step(random);
  rooms.beginTick();
  scores.beginTick(static_cast<std::uint32_t>(step_count));
}

void WorldExtras::endTick(bool paused) {
  if (!paused) animations.advance();
  scores.endTick();
}

WorldExtras& LazyExtras::get() {
  if (m_p_extras == nullptr) {
    m_p_extras = std::make_unique<WorldExtras>(m_store, m_log, m_state);
    m_log.setFile(&m_p_extras->settings.logfile);
  }
  return *m_p_extras;
}

}  // namespace df
