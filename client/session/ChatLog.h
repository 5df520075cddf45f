// What was said lately, by whom and in which colour.
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

/// A line of chat and when it came.
struct ChatEntry {
  std::string name;  ///< of the speaker; empty: the server
  df::Color color = df::COLOR_DEFAULT;
  std::string text;
  std::chrono::steady_clock::time_point at;
};

class ChatLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMax = 100;  ///< lines kept

  /// Somebody of `players`, or who plays here (`self`), or the server said something.
  void note(ChatMessage message, const std::vector<PlayerLine>& players, const WelcomeMessage& self,
            Time now);
  /// A line of the client's own.
  void say(std::string text, Time now) { add({"", df::COLOR_DEFAULT, std::move(text), now}); }

  /// Oldest first.
  const std::deque<ChatEntry>& entries() const { return m_entries; }

 private:
  void add(ChatEntry entry);

  std::deque<ChatEntry> m_entries;
};

}  // namespace naiad
