// A second stream beside that of the session, where datagrams do not pass.
//
// TCP delivers in order, so a lost packet holds up all that comes after it for a round trip and more. The
// same snapshots and updates go on both streams; they seldom wait at the same time. What needs order
// (chat, players, music) stays on the first.
//
// Pure: the owner connects, and passes time in.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "client/session/SessionOptions.h"
#include "shared/net/base/Channel.h"

namespace naiad {

class SecondStream {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Between two attempts, at first; doubled with each up to kLastPause, unless the one before lasted longer.
  static constexpr std::chrono::seconds kFirstPause{2};
  static constexpr std::chrono::seconds kLastPause{64};
  /// It is closed after this much silence, be it in answer to the hello or later.
  static constexpr std::chrono::seconds kMaxSilence{5};

  SecondStream() = default;
  ~SecondStream() { close(); }
  SecondStream(const SecondStream&) = delete;
  SecondStream& operator=(const SecondStream&) = delete;

  /// May one be opened now? True once for each attempt.
  bool takeAttempt(Time now);
  /// Say hello on `channel`; `on_snapshot` gets its snapshots once the server has accepted it. A server
  /// that sends anything else there loses this stream, nothing more.
  void start(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
             std::function<void(std::string_view bytes)> on_snapshot);
  /// Close it if it is silent. Call now and then.
  void update(Time now);
  /// The server has accepted it.
  bool isOpen() const { return m_open; }
  /// A snapshot came, on either stream. True if it is among the last ones that did: it came on the other.
  bool isRepeat(std::string_view snapshot);
  /// Send a frame if it is open, and nothing waits on it.
  void send(std::string_view frame);
  /// Done with it; another one may be opened later.
  void close();

 private:
  void receive(std::string_view frame, Time now);

  std::unique_ptr<ReliableChannel> m_channel;
  std::function<void(std::string_view)> m_on_snapshot;
  bool m_open = false;
  /// Of the last snapshots; fewer than it takes until the 16 bits of a number repeat.
  std::array<std::size_t, 64> m_hashes{};
  std::size_t m_heard = 0;
  std::chrono::seconds m_pause = kFirstPause;
  Time m_next_attempt{};
  Time m_started{};
  Time m_last_heard{};
};

}  // namespace naiad
