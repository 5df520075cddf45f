#include "engine/world/Sound.h"

#include "engine/world/World.h"

namespace df {

int Sound::loadSound(const std::string& filename) {
  return World::current().findFile(m_music ? "Music" : "Sound", filename) ? 0 : -1;
}

void Sound::endLoop() {
  if (World::current().isPlaying(m_label, m_music)) stop();
}

void Sound::recordSound(SoundPlayed::What what, bool loop) {
  if (!m_silent) World::current().recordSound({m_label, what, m_music, loop});
}

}  // namespace df
