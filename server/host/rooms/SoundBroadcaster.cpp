#include "host/rooms/SoundBroadcaster.h"

#include <algorithm>
#include <utility>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

static_assert(SoundBroadcaster::kPerTick <= kMaxSounds);

/// True if a client that missed this sound would play other sounds than the game from then on.
bool lasts(const df::SoundPlayed& sound) {
  return sound.music || sound.loop || sound.what != df::SoundPlayed::kPlay;
}

/// A lasting sound costs as much as three others, because it is stored for disconnected clients and must not
/// use up their storage.
constexpr std::uint32_t kLastingWeight = 3;

std::uint32_t costOf(const df::SoundPlayed& sound) {
  return SoundBroadcaster::kTicksPerSound * (lasts(sound) ? kLastingWeight : 1);
}

/// Returns the rank of a sound for a player; lower ranks are sent first.
int rankOf(const df::SoundPlayed& sound, std::uint32_t player) {
  if (lasts(sound)) return 0;
  if (sound.player == player) return 1;
  return sound.player == 0 ? 2 : 3;
}
constexpr int kRanks = 4;

wire::Sound::Action actionOf(const df::SoundPlayed& sound) {
  if (sound.what == df::SoundPlayed::kPause) return wire::Sound::PAUSE;
  return sound.what == df::SoundPlayed::kStop ? wire::Sound::STOP : wire::Sound::PLAY;
}

void addSound(wire::ServerMessage& message, const df::SoundPlayed& played) {
  wire::Sound& sound = *message.mutable_sounds()->add_sounds();
  sound.set_label(safeText(played.label, kMaxSoundLabel));
  sound.set_action(actionOf(played));
  sound.set_music(played.music);
  sound.set_loop(played.loop);
  sound.set_player(played.player);
}

}  // namespace

void SoundBroadcaster::tick(const df::WorldView& view, const Send& send) {
  gatherSounds(view);
  std::swap(m_listeners, m_listeners_before);
  m_listeners.clear();
  auto before = m_listeners_before.begin();
  for (const df::PlayerFacts& player : view.players) {  // sorted by id, like m_listeners
    while (before != m_listeners_before.end() && before->player < player.id) ++before;
    const bool is_new = before == m_listeners_before.end() || before->player != player.id;
    Listener& listener = m_listeners.emplace_back(is_new ? addListener(player.id, view, send) : *before);
    if (!m_now.empty()) sendSounds(listener, is_new, view.tick, send);
  }
}

void SoundBroadcaster::gatherSounds(const df::WorldView& view) {
  m_now.clear();
  m_overflowed = view.sounds_lost;
  for (const df::SoundPlayed& sound : view.sounds) {
    updateLasting(sound);
    const bool known = std::any_of(m_now.begin(), m_now.end(),
                                   [&sound](const df::SoundPlayed* other) { return *other == sound; });
    if (known) continue;
    if (m_now.size() < kMaxDifferent) {
      m_now.push_back(&sound);
    } else {
      ++m_overflowed;
    }
  }
}

// If more sounds last than fit in one message, drops the oldest that does not loop, because it has most
// likely ended; if all loop, drops the oldest.
void SoundBroadcaster::updateLasting(const df::SoundPlayed& sound) {
  if (!lasts(sound)) return;
  std::erase_if(m_lasting, [&sound](const df::SoundPlayed& other) {
    return other.music == sound.music && other.label == sound.label;
  });
  if (sound.what == df::SoundPlayed::kStop) return;
  if (m_lasting.size() == kMaxSounds) {
    const auto once = std::find_if(m_lasting.begin(), m_lasting.end(),
                                   [](const df::SoundPlayed& other) { return !other.loop; });
    m_lasting.erase(once != m_lasting.end() ? once : m_lasting.begin());
  }
  m_lasting.push_back(sound);
}

SoundBroadcaster::Listener SoundBroadcaster::addListener(std::uint32_t player, const df::WorldView& view,
                                                         const Send& send) {
  wire::ServerMessage message;
  for (const df::SoundPlayed& sound : view.playing) {
    updateLasting(sound);
    if (message.sounds().sounds_size() < static_cast<int>(kMaxSounds)) addSound(message, sound);
  }
  if (!view.playing.empty()) sendMessage(player, message, true, send);
  return {player, kBurst * kTicksPerSound, view.tick};
}

// Loops are skipped for a new player, because addListener() has just sent them.
void SoundBroadcaster::sendSounds(Listener& listener, bool is_new, std::uint32_t tick, const Send& send) {
  listener.credit = std::min(listener.credit + (tick - listener.tick), kBurst * kTicksPerSound);
  listener.tick = tick;
  m_chosen.assign(m_now.size(), false);
  std::size_t room = kPerTick;
  std::size_t left = m_now.size();
  for (int rank = 0; rank < kRanks; ++rank) {
    for (std::size_t i = 0; i < m_now.size(); ++i) {
      if (rankOf(*m_now[i], listener.player) != rank) continue;
      if (is_new && m_now[i]->loop) {
        --left;
        continue;
      }
      if (room == 0 || listener.credit < costOf(*m_now[i])) continue;
      m_chosen[i] = true;
      --room;
      --left;
      listener.credit -= costOf(*m_now[i]);
    }
  }
  m_dropped += left + m_overflowed;
  for (const bool lasting : {true, false}) {
    wire::ServerMessage message;
    for (std::size_t i = 0; i < m_now.size(); ++i) {
      if (m_chosen[i] && lasts(*m_now[i]) == lasting) addSound(message, *m_now[i]);
    }
    if (message.has_sounds()) sendMessage(listener.player, message, lasting, send);
  }
}

void SoundBroadcaster::sendMessage(std::uint32_t player, const wire::ServerMessage& message, bool lasts,
                                   const Send& send) {
  const auto count = static_cast<std::uint64_t>(message.sounds().sounds_size());
  (send(player, message, lasts) ? m_sent : m_dropped) += count;
}

wire::ServerMessage SoundBroadcaster::stops() const {
  wire::ServerMessage message;
  for (const df::SoundPlayed& sound : m_lasting)
    addSound(message, {sound.label, df::SoundPlayed::kStop, sound.music, sound.loop, 0});
  return message;
}

void SoundBroadcaster::stopFor(std::uint32_t player, const Send& send) {
  const wire::ServerMessage message = stops();
  if (message.has_sounds()) sendMessage(player, message, true, send);
  repeat(player);
}

void SoundBroadcaster::changeWorld(const Send& send) {
  const wire::ServerMessage message = stops();
  if (message.has_sounds()) {
    for (const Listener& listener : m_listeners) sendMessage(listener.player, message, true, send);
  }
  m_lasting.clear();
  m_listeners.clear();
}

void SoundBroadcaster::repeat(std::uint32_t player) {
  std::erase_if(m_listeners, [player](const Listener& listener) { return listener.player == player; });
}

}  // namespace naiad
