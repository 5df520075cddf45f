#include "client/session/ReliableInbox.h"

namespace naiad {

bool ReliableInbox::isNew(std::uint32_t number) {
  if (m_received.accept(number)) return true;
  ++m_counters.repeated_frames;
  return false;
}

void ReliableInbox::handlePlayers(PlayersMessage&& message) {
  if (isNew(message.number)) m_players = std::move(message.players);
}

void ReliableInbox::handleChat(ChatMessage&& message, const WelcomeMessage& self, Time now) {
  if (!isNew(message.number)) return;
  ChatEntry entry{"", df::COLOR_DEFAULT, std::move(message.text), now};
  if (message.player != 0) entry.name.assign(1, '?');  // the speaker has already left
  for (const PlayerLine& player : m_players) {
    if (message.player == 0 || player.player != message.player) continue;
    entry.name = player.name;
    entry.color = player.color;
  }
  if (message.player != 0 && message.player == self.player) {
    entry.name = self.name;
    entry.color = self.color;
  }
  addLine(std::move(entry));
  ++m_counters.chat_lines;
}

void ReliableInbox::addLine(ChatEntry entry) {
  m_chat.push_back(std::move(entry));
  if (m_chat.size() > kMaxChat) m_chat.pop_front();
}

void ReliableInbox::handleSounds(SoundsMessage&& message) {
  if (!isNew(message.number)) return;
  m_counters.sounds += message.sounds.size();
  for (SoundLine& sound : message.sounds) m_sounds.push_back(std::move(sound));
  if (m_sounds.size() <= kMaxSounds) return;
  m_sounds.erase(m_sounds.begin(), m_sounds.end() - static_cast<std::ptrdiff_t>(kMaxSounds));
}

bool ReliableInbox::countFrame(std::size_t bytes) {
  m_unacknowledged_bytes += bytes;
  return m_unacknowledged_bytes >= kAckThreshold;
}

std::int32_t ReliableInbox::scoreOf(std::uint32_t player) const {
  for (const PlayerLine& line : m_players) {
    if (line.player == player) return line.score;
  }
  return 0;
}

}  // namespace naiad
