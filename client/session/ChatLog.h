// The newest lines of chat, with their speakers and colours.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "client/session/ServerMessages.h"
#include "shared/values/Color.h"

namespace naiad {

/// A line of chat and when it arrived.
struct ChatEntry {
  std::string name;  ///< of the speaker; empty: the server
  df::Color color = df::COLOR_DEFAULT;
  std::string text;
  std::chrono::steady_clock::time_point at;
};

class ChatLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMax = 500;  ///< lines kept

  /// A line of a player (one of `players`, or this one, `self`) or of the server.
  void addMessage(ChatMessage message, const std::vector<PlayerLine>& players, const WelcomeMessage& self,
                  Time now);
  /// A line of the client itself.
  void addNotice(std::string text, Time now) { add({"", df::COLOR_DEFAULT, std::move(text), now}); }

  /// Oldest first.
  const std::deque<ChatEntry>& entries() const { return m_entries; }

 private:
  void add(ChatEntry entry);

  std::deque<ChatEntry> m_entries;
};

}  // namespace naiad
