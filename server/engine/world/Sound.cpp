#include "engine/world/Sound.h"

#include <fstream>

#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

int Sound::loadSound(const std::string& filename) {
  World& world = World::current();
  if (world.extras().resources.open(filename)) return 0;
  world.log(std::string(m_music ? "Music: " : "Sound: ") + filename + ": cannot be read" +
            world.extras().resources.lookedIn(filename));
  return -1;
}

void Sound::play(bool loop) {
  notePlayed(SoundPlayed::kPlay, loop);
}

void Sound::stop() {
  notePlayed(SoundPlayed::kStop, false);
}

void Sound::pause() {
  notePlayed(SoundPlayed::kPause, false);
}

void Sound::endLoop() {
  if (World::current().extras().isPlaying(m_label, m_music)) stop();
}

void Sound::notePlayed(SoundPlayed::What what, bool loop) {
  if (m_silent) return;
  World& world = World::current();
  world.noteSound({m_label, what, m_music, loop, world.inputPlayer()});
}

}  // namespace df
