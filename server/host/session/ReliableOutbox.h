// Frames that must reach a client even if its stream breaks or is slow: chat, player lists, lasting sounds.
//
// Each frame has a number and is kept until the client acknowledges it (receiver: ReliableFrames.h). Memory
// is limited whatever other players and the game send, and a full outbox never ends a session: the oldest
// unsent sounds and chat lines are dropped, and one line in place of the chat lines says how many.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>

namespace naiad {

struct Counters;

namespace wire {
class ServerMessage;
}

/// Not thread-safe. Frames are sent in the order in which they were added. Only frames that were never sent
/// are dropped: a sent one may have arrived, and the reported number must be exact.
class ReliableOutbox {
 public:
  /// Limit of all kept frames, in bytes including headers.
  static constexpr std::size_t kMax = std::size_t{64} * 1024;
  /// Flow-control window: further frames wait while this many bytes on the stream are
  /// unacknowledged. A client acknowledges at the latest after half of it.
  static constexpr std::size_t kWindow = std::size_t{16} * 1024;
  /// Limit of unsent sounds, in bytes. Only the newest state of each sound is kept.
  static constexpr std::size_t kMaxSounds = std::size_t{16} * 1024;

  explicit ReliableOutbox(Counters& counters) : m_counters(counters) {}

  /// Adds a message of chat, players or sounds. A player list replaces the previous one, a sound the previous
  /// one with the same label.
  void add(const wire::ServerMessage& message);
  /// Drops the frames up to `number`, which the client has. Ignores numbers that were never sent.
  void acknowledge(std::uint32_t number);
  /// Call for a new stream: everything kept is sent again.
  void restartStream();
  /// Call when another process of the client resumes the session: drops all frames. Numbers continue.
  void clear();

  /// Returns the next frame to send on the stream; null if none waits or the window is full.
  const std::string* next() const;
  /// Call when the frame of next() was sent.
  void markSent();

  std::size_t bytes() const { return m_bytes; }

 private:
  enum class Kind : std::uint8_t { kChat, kNotice, kPlayers, kSound };
  struct ReliableFrame {
    std::uint32_t number = 0;
    Kind kind = Kind::kChat;
    bool sent = false;  ///< sent over any stream; such frames are at the front of the queue
    std::string label;  ///< identifies a sound: its label, and whether it is music
    std::string frame;
    std::uint64_t lines = 0;  ///< dropped chat lines that a notice reports
    std::size_t size() const;
  };

  void append(wire::ServerMessage message, Kind kind, std::string label);
  void addSounds(const wire::ServerMessage& message);
  bool replaceUnsent(wire::ServerMessage& message, Kind kind, const std::string& label);
  void erase(std::size_t index);
  void limit();
  void count(const ReliableFrame& kept);
  void discount(const ReliableFrame& kept);
  bool dropOldestChat();
  bool dropOldestSound();
  std::size_t findUnsent(Kind kind) const;

  Counters& m_counters;
  std::deque<ReliableFrame> m_kept;  ///< sorted by number
  std::size_t m_bytes = 0;           ///< size of m_kept
  std::size_t m_sound_bytes = 0;     ///< part of m_bytes: unsent sounds
  std::size_t m_on_stream = 0;       ///< frames at the front of m_kept that this stream has carried
  std::size_t m_bytes_on_stream = 0;
  std::uint32_t m_next = 1;         ///< number of the next frame; never 0
  std::uint32_t m_newest_sent = 0;  ///< number of the newest frame sent; 0: none
};

}  // namespace naiad
