#include "client/session/ChatLog.h"

#include <utility>

namespace naiad {

void ChatLog::addMessage(ChatMessage message, const std::vector<PlayerLine>& players,
                         const WelcomeMessage& self, Time now) {
  ChatEntry entry{"", df::COLOR_DEFAULT, std::move(message.text), now};
  if (message.player != 0) entry.name.assign(1, '?');  // has left already
  for (const PlayerLine& player : players) {
    if (message.player == 0 || player.player != message.player) continue;
    entry.name = player.name;
    entry.color = player.color;
  }
  if (message.player != 0 && message.player == self.player) {
    entry.name = self.name;
    entry.color = self.color;
  }
  add(std::move(entry));
}

void ChatLog::add(ChatEntry entry) {
  m_entries.push_back(std::move(entry));
  if (m_entries.size() > kMax) m_entries.pop_front();
}

}  // namespace naiad
