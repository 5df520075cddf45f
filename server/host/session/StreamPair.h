// A session's two streams, and the callbacks that lead from them to the session.
//
// A stream outlives the session that heard its hello: takeFirst() and takeSecond() hand it to another pair,
// and from then on its callbacks lead there.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"

namespace naiad {

/// Does the other end of a stream still take in what it is sent?
/// A stream is stuck if more than kMuch is unsent and that has not become less for kPatience. A slow stream
/// is not: each new minimum restarts the time. Pure.
class StallDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kMuch = std::size_t{64} * 1024;  ///< bytes
  static constexpr std::chrono::seconds kPatience{10};

  /// At `now` the stream has so many bytes unsent. True if it is stuck.
  bool addSample(std::size_t unsent, Time now) {
    if (unsent <= kMuch || m_least == 0 || unsent < m_least) {
      m_least = unsent <= kMuch ? 0 : unsent;
      m_since = now;
      return false;
    }
    return now - m_since >= kPatience;
  }
  /// Another stream.
  void restart() { m_least = 0; }

 private:
  std::size_t m_least = 0;  ///< the minimum since more than kMuch was unsent; 0: no more than that is
  Time m_since{};
};

/// Not thread-safe. The first stream carries everything; the second one, small snapshots again.
class StreamPair {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Callbacks {
    std::function<void(std::string_view frame)> on_frame;
    std::function<void(CloseReason)> on_closed;
    std::function<void(std::string_view frame)> on_second_frame;
    std::function<void(CloseReason)> on_second_closed;
  };

  explicit StreamPair(std::unique_ptr<ReliableChannel> first);
  StreamPair(const StreamPair&) = delete;
  StreamPair& operator=(const StreamPair&) = delete;

  /// Begin to receive. `limit`: bytes of a frame, at most.
  void start(Callbacks callbacks, std::size_t limit);
  /// The same for the frames that come from now on.
  void setReceiveLimit(std::size_t limit) { m_first->setReceiveLimit(limit); }

  /// Take over the first stream of `other`, which gets this one's in exchange if it is not broken.
  void takeFirst(StreamPair& other);
  /// Take over the first stream of `other` as the second one here; a second one that is here already ends.
  void takeSecond(StreamPair& other, std::size_t limit);
  void dropSecond();
  /// The first stream is broken: go on without any.
  void detach();
  void close();

  /// Null while detached.
  const ReliableChannel* first() const { return m_first.get(); }
  bool hasSecond() const { return m_second != nullptr; }
  /// There is one, and nothing waits on it to be sent.
  bool isFirstIdle() const { return isIdle(m_first.get()); }
  bool isSecondIdle() const { return isIdle(m_second.get()); }
  /// To be asked once a tick. Has the first stream taken in nothing for too long (StallDetector)?
  bool isStalled(Time now) { return m_first != nullptr && m_stall.addSample(m_first->unsentBytes(), now); }
  /// The address of the first stream, or that of the last one.
  std::string peerAddress() const { return m_first != nullptr ? m_first->peerAddress() : m_address; }

  /// Dropped if there is no such stream.
  void sendFirst(std::string_view frame);
  void sendSecond(std::string_view frame);

 private:
  /// Where the callbacks of one stream lead.
  struct Route {
    StreamPair* pair = nullptr;
    bool second = false;
  };

  static bool isIdle(const ReliableChannel* stream) {
    return stream != nullptr && stream->unsentBytes() == 0;
  }

  Callbacks m_callbacks;
  std::string m_address;                      ///< of the last first stream, while there is none
  std::unique_ptr<ReliableChannel> m_first;   ///< null while detached
  std::unique_ptr<ReliableChannel> m_second;  ///< null: there is none
  StallDetector m_stall;                      ///< of the first
  std::shared_ptr<Route> m_route = std::make_shared<Route>();  ///< of the first
};

}  // namespace naiad
