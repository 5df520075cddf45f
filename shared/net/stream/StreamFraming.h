// Cuts a stream of bytes into messages, in the way that StreamConnection needs: by
// lengths (LengthFraming, Framing.h), or as a WebSocket (shared/net/http/WebSocketFraming.h).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

/// Reads and writes for one connection. No sockets, no clock; not thread-safe.
class StreamFraming {
 public:
  virtual ~StreamFraming() = default;

  /// The largest payload accepted from the peer from now on, in bytes.
  virtual void setLimit(std::size_t bytes) = 0;
  /// Hands over the next piece of the stream, which must stay where it is until next() returned nullopt.
  virtual void feed(std::string_view bytes) = 0;
  /// The next whole payload. The view is valid until the next call of next() or feed().
  virtual std::optional<std::string_view> next() = 0;
  /// True after the peer broke the rules; next() then returns nullopt for good.
  virtual bool isBroken() const = 0;
  /// True if the stream may not end here: a part of a frame was received.
  virtual bool midFrame() const = 0;
  /// Set when a frame said that the peer closes, with the reason to report; nothing is received after it.
  virtual std::optional<CloseReason> peerClosed() const { return std::nullopt; }

  /// Appends a frame with this payload to `out`. Throws std::length_error if it cannot be one.
  virtual void append(std::string& out, std::string_view payload) = 0;
  /// Appends what the framing itself answers to what it read.
  virtual void appendReplies(std::string& /*out*/) {}
  /// Appends a frame that says that nothing follows, once, where the framing has such a frame.
  virtual void appendEnd(std::string& /*out*/) {}
};

/// Framing.h: Naiad's own.
class LengthFraming : public StreamFraming {
 public:
  explicit LengthFraming(std::size_t limit) : reader_(limit) {}

  void setLimit(std::size_t bytes) override { reader_.setLimit(bytes); }
  void feed(std::string_view bytes) override { reader_.feed(bytes); }
  std::optional<std::string_view> next() override { return reader_.next(); }
  bool isBroken() const override { return reader_.error() != FrameError::kNone; }
  bool midFrame() const override { return reader_.midFrame(); }
  void append(std::string& out, std::string_view payload) override { appendFrame(out, payload); }

 private:
  FrameReader reader_;
};

}  // namespace naiad
