#include "client/ui/SoundIndicator.h"

namespace naiad {

namespace {

std::string textOf(const SoundLine& sound) {
  return (sound.music ? "music: " : "sound: ") + sound.label;
}

}  // namespace

std::optional<SoundMode> soundModeFrom(std::string_view name) {
  if (name == "note") return SoundMode::kNote;
  if (name == "bell") return SoundMode::kBell;
  if (name == "off") return SoundMode::kOff;
  return std::nullopt;
}

void SoundIndicator::addSound(const SoundLine& sound, std::uint32_t self, Time now) {
  if (m_mode == SoundMode::kOff) return;
  if (sound.action != SoundLine::Action::kPlay) {
    if (m_note == textOf(sound)) m_noted_at.reset();  // the sound has ended
    return;
  }
  const bool others = sound.player != 0 && sound.player != self;
  show(sound, others, now);
  if (m_mode != SoundMode::kBell || sound.music || others) return;
  if (m_rang_at && now - *m_rang_at < kMinBellInterval) return;
  m_rang_at = now;
  m_rings = true;
}

// A sound of this player, or of no player, replaces another player's note at once. Otherwise, a sound within
// kMin of the last note is not shown.
void SoundIndicator::show(const SoundLine& sound, bool others, Time now) {
  const bool recent = m_noted_at && now - *m_noted_at < kMin;
  if (recent && (others || !m_of_others)) return;
  m_note = textOf(sound);
  m_of_others = others;
  m_noted_at = now;
}

std::string SoundIndicator::shownNote(Time now) const {
  return m_noted_at && now - *m_noted_at < kShown ? m_note : std::string();
}

}  // namespace naiad
