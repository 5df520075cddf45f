// A session's two streams, and the callbacks from them to the session.
//
// A stream outlives the session that received its hello: adoptFirst() and adoptAsSecond() move it to another
// pair, which then gets its callbacks.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"

namespace naiad {

/// Detects a peer that no longer reads its stream. A stream is stuck if more than kStallThreshold bytes are
/// unsent and the number has not reached a new minimum for kStallTimeout. A slow stream is not stuck: each
/// new minimum restarts the time. Callers pass the time.
class StallDetector {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::size_t kStallThreshold = std::size_t{64} * 1024;  ///< bytes
  static constexpr std::chrono::seconds kStallTimeout{10};

  /// Records the number of unsent bytes; returns true if the stream is stuck.
  bool addSample(std::size_t unsent, Time now) {
    if (unsent <= kStallThreshold || m_min_unsent == 0 || unsent < m_min_unsent) {
      m_min_unsent = unsent <= kStallThreshold ? 0 : unsent;
      m_since = now;
      return false;
    }
    return now - m_since >= kStallTimeout;
  }
  /// Call when another stream replaces the observed one.
  void restart() { m_min_unsent = 0; }

 private:
  std::size_t m_min_unsent =
      0;  ///< minimum of the unsent bytes since they exceeded kStallThreshold; 0: they do not exceed it
  Time m_since{};
};

/// Not thread-safe. The first stream carries everything; the second one only small snapshots and updates.
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

  /// Starts to receive. `limit`: maximum size of a frame, in bytes.
  void start(Callbacks callbacks, std::size_t limit);
  /// Sets the maximum size of frames received from now on, in bytes.
  void setReceiveLimit(std::size_t limit) { m_first->setReceiveLimit(limit); }

  /// Takes the first stream of `other`. If this pair still has one, `other` gets it in exchange. Closes the
  /// second stream of this pair.
  void adoptFirst(StreamPair& other);
  /// Takes the first stream of `other` as the second one of this pair. An earlier second stream is closed.
  void adoptAsSecond(StreamPair& other, std::size_t limit);
  void dropSecond();
  /// Drops both streams, because the first one broke.
  void detach();
  void close();

  /// Returns the first stream; null while detached.
  const ReliableChannel* first() const { return m_first.get(); }
  bool hasSecond() const { return m_second != nullptr; }
  /// True if the stream exists and has no unsent bytes.
  bool isFirstIdle() const { return isIdle(m_first.get()); }
  bool isSecondIdle() const { return isIdle(m_second.get()); }
  /// Call once a tick. True if the first stream is stuck (StallDetector).
  bool isStalled(Time now) { return m_first != nullptr && m_stall.addSample(m_first->unsentBytes(), now); }
  /// Address of the first stream, or of the last one while detached.
  std::string peerAddress() const { return m_first != nullptr ? m_first->peerAddress() : m_address; }

  /// Sends the frame, or drops it if there is no such stream.
  void sendFirst(std::string_view frame);
  void sendSecond(std::string_view frame);

 private:
  /// The pair and stream that get the callbacks of one stream.
  struct Route {
    StreamPair* pair = nullptr;
    bool second = false;
  };

  static bool isIdle(const ReliableChannel* stream) {
    return stream != nullptr && stream->unsentBytes() == 0;
  }

  Callbacks m_callbacks;
  std::string m_address;                      ///< address of the previous first stream; used while detached
  std::unique_ptr<ReliableChannel> m_first;   ///< null while detached
  std::unique_ptr<ReliableChannel> m_second;  ///< null if none
  StallDetector m_stall;                      ///< observes the first stream
  std::shared_ptr<Route> m_route = std::make_shared<Route>();  ///< route of the first stream
};

}  // namespace naiad
