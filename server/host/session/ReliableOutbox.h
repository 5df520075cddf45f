// What a client must get even if its stream breaks or is slow: chat, the list of players, lasting sounds.
//
// Each frame has a number and is kept until the client says that it came (ReliableFrames.h has the other
// end). What is kept is bounded whatever the other players and the game do, and never a reason to end a
// session: when it is full, the oldest lines of chat that were not sent yet are left out, and one line in
// their place says how many they were.
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

/// Not thread-safe. Frames are sent in the order in which they were added. One that was sent is never left
/// out, since it may have arrived, so that what the client is told is exact.
class ReliableOutbox {
 public:
  /// Kept at most, in bytes with their headers.
  static constexpr std::size_t kMax = std::size_t{64} * 1024;
  /// With so many bytes sent on a stream and not acknowledged, the next frames wait. A client acknowledges as
  /// soon as it got half of it.
  static constexpr std::size_t kWindow = std::size_t{16} * 1024;
  /// Bytes of sounds that wait, at most: of different ones, since of each only the newest state is kept.
  static constexpr std::size_t kMaxSounds = std::size_t{16} * 1024;

  explicit ReliableOutbox(Counters& counters) : m_counters(counters) {}

  /// Keep a message of chat, players or sounds. A list of players replaces the one before, a sound the one of
  /// the same label.
  void add(const wire::ServerMessage& message);
  /// The client has all up to `number`. What was never sent is no acknowledgement.
  void acknowledge(std::uint32_t number);
  /// Another stream: what is kept is to be sent again.
  void restartStream();
  /// Another process of the client, for which nothing of this is meant; numbers go on.
  void clear();

  /// The next frame to send on the stream; null if there is none, or too much is unacknowledged.
  const std::string* next() const;
  /// It was sent.
  void noteSent();

  std::size_t bytes() const { return m_bytes; }

 private:
  enum class Kind : std::uint8_t { kChat, kNotice, kPlayers, kSound };
  struct Kept {
    std::uint32_t number = 0;
    Kind kind = Kind::kChat;
    bool sent = false;  ///< on this stream or an earlier one; these are the first ones
    std::string label;  ///< of a sound, which is music or not
    std::string frame;
    std::uint64_t lines = 0;  ///< of chat that a notice stands for
    std::size_t size() const;
  };

  void append(wire::ServerMessage message, Kind kind, std::string label);
  void addSounds(const wire::ServerMessage& message);
  bool replaceUnsent(wire::ServerMessage& message, Kind kind, const std::string& label);
  void erase(std::size_t index);
  void limit();
  void count(const Kept& kept);
  void discount(const Kept& kept);
  bool leaveOutChat();
  bool leaveOutSound();
  std::size_t findUnsent(Kind kind) const;

  Counters& m_counters;
  std::deque<Kept> m_kept;        ///< by number
  std::size_t m_bytes = 0;        ///< of m_kept
  std::size_t m_sound_bytes = 0;  ///< of these, sounds that were never sent
  std::size_t m_on_stream = 0;    ///< so many of the first were sent on this stream
  std::size_t m_bytes_on_stream = 0;
  std::uint32_t m_next = 1;         ///< number; never 0
  std::uint32_t m_newest_sent = 0;  ///< number; 0: none
};

}  // namespace naiad
