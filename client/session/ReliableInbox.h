// Reliable messages from the server: the list of players, chat and sounds. Each frame is handled once,
// although the server may send it again on the session's next stream.
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

struct ChatEntry {
  std::string name;  ///< name of the speaker; "?": unknown; empty: the server or this client
  df::Color color = df::COLOR_DEFAULT;
  std::string text;
  std::chrono::steady_clock::time_point at;  ///< time of arrival
};

class ReliableInbox {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMaxChat = 500;   ///< number of stored lines
  static constexpr std::size_t kMaxSounds = 32;  ///< number of sounds stored for popSounds()
  /// This many unacknowledged bytes of reliable frames are acknowledged before the next regular ping.
  static constexpr std::size_t kAckThreshold = std::size_t{8} * 1024;

  /// `counters` must outlive the inbox.
  explicit ReliableInbox(SessionCounters& counters) : m_counters(counters) {}

  void handlePlayers(PlayersMessage&& message);
  void handleChat(ChatMessage&& message, const WelcomeMessage& self, Time now);
  void handleSounds(SoundsMessage&& message);
  /// Adds a line from the client itself to the chat.
  void addNotice(std::string text, Time now) { addLine({"", df::COLOR_DEFAULT, std::move(text), now}); }

  /// Number of the newest reliable frame received; 0: none.
  std::uint32_t newestFrame() const { return m_received.newest(); }
  /// Counts a new reliable frame of this size. Returns true if the frames should be acknowledged now.
  bool countFrame(std::size_t bytes);
  /// Call when all received frames have been acknowledged.
  void onAcknowledged() { m_unacknowledged_bytes = 0; }

  const std::vector<PlayerLine>& players() const { return m_players; }
  /// Returns the points of this player in the newest list; 0 if the player is not in it.
  std::int32_t scoreOf(std::uint32_t player) const;
  /// The newest lines, oldest first.
  const std::deque<ChatEntry>& chat() const { return m_chat; }
  /// Returns the sounds since the last call, oldest first, at most the newest kMaxSounds.
  std::vector<SoundLine> popSounds() { return std::exchange(m_sounds, {}); }

 private:
  bool isNew(std::uint32_t number);
  void addLine(ChatEntry entry);

  SessionCounters& m_counters;
  ReliableFrameReceiver m_received;
  std::size_t m_unacknowledged_bytes = 0;
  std::vector<PlayerLine> m_players;
  std::deque<ChatEntry> m_chat;
  std::vector<SoundLine> m_sounds;
};

}  // namespace naiad
