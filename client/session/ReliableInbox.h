// What the server sends reliably: the list of players, chat and sounds. Each frame counts once, although it
// may come again on the session's next stream.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "client/session/ServerMessages.h"
#include "client/session/SessionCounters.h"
#include "shared/net/stream/ReliableFrames.h"
#include "shared/values/Color.h"

namespace naiad {

/// A line of chat and when it arrived.
struct ChatEntry {
  std::string name;  ///< of the speaker; empty: the server
  df::Color color = df::COLOR_DEFAULT;
  std::string text;
  std::chrono::steady_clock::time_point at;
};

class ReliableInbox {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMaxChat = 500;   ///< lines kept
  static constexpr std::size_t kMaxSounds = 32;  ///< sounds kept until fetchSounds()
  /// So many bytes of reliable frames are acknowledged immediately, not with the next ping.
  static constexpr std::size_t kMuchKept = std::size_t{8} * 1024;

  /// `counters` must outlive the inbox.
  explicit ReliableInbox(SessionCounters& counters) : m_counters(counters) {}

  void takePlayers(PlayersMessage&& message);
  void takeChat(ChatMessage&& message, const WelcomeMessage& self, Time now);
  void takeSounds(SoundsMessage&& message);
  /// Add a line of the client itself to the chat.
  void addNotice(std::string text, Time now) { addLine({"", df::COLOR_DEFAULT, std::move(text), now}); }

  /// Number of the newest reliable frame received; 0: none.
  std::uint32_t newestFrame() const { return m_received.newest(); }
  /// A new reliable frame had this size. True if it is time to acknowledge.
  bool noteFrameSize(std::size_t bytes);
  /// All received frames are acknowledged now.
  void noteAcknowledged() { m_unacknowledged_bytes = 0; }

  const std::vector<PlayerLine>& players() const { return m_players; }
  /// Points of this player in the newest list.
  std::int32_t scoreOf(std::uint32_t player) const;
  /// The newest lines, oldest first.
  const std::deque<ChatEntry>& chat() const { return m_chat; }
  /// Sounds since the last call, oldest first; the newest kMaxSounds of them.
  std::vector<SoundLine> fetchSounds() { return std::exchange(m_sounds, {}); }

 private:
  bool isNew(std::uint32_t number);
  void addLine(ChatEntry entry);

  SessionCounters& m_counters;
  ReliableFramesHeard m_received;
  std::size_t m_unacknowledged_bytes = 0;
  std::vector<PlayerLine> m_players;
  std::deque<ChatEntry> m_chat;
  std::vector<SoundLine> m_sounds;
};

}  // namespace naiad
