// Frames on a byte stream: where one message ends and the next begins.
//
//   +----------------+----------------+---------------------+
//   | length, low 8  | length, high 8 | payload, length B   |   length = 1 … 65535, little-endian
//   +----------------+----------------+---------------------+
//
// Two bytes, because the largest frame either end may send (Limits.h) is 16 KiB. There is no frame of
// length zero. The writing side treats a wrong size as a bug of the caller; the reading side believes
// nothing: it checks the length before it keeps a byte of the payload, and keeps only bytes that came.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"

namespace naiad {

/// Bytes in front of each payload.
inline constexpr std::size_t kFrameHeaderSize = 2;
/// The largest payload that the length prefix can express, in bytes.
inline constexpr std::size_t kMaxFramePayload = 0xffff;

/// Append header and payload to `out`.
/// Throws std::length_error if the payload is empty or longer than kMaxFramePayload; `out` is unchanged.
void appendFrame(std::string& out, std::string_view payload);

/// The header in front of a payload of `length` bytes, for those who have room for it there. `length` is
/// 1 … kMaxFramePayload (asserted).
void writeFrameHeader(std::span<char, kFrameHeaderSize> into, std::size_t length);

/// What made a FrameReader give up.
enum class FrameError {
  kNone,
  kEmpty,     ///< a frame of length zero
  kTooLarge,  ///< a frame longer than the limit
};

/// Cuts a stream of bytes, arriving in any pieces, back into frames.
///
///   reader.feed(bytes);
///   while (auto frame = reader.next()) use(*frame);
///   if (reader.error() != FrameError::kNone) hangUp();
///
/// Memory: frames that arrive whole are not copied; of an incomplete one, the bytes received so far are
/// kept, never more than header + limit. A peer that only claims a large frame costs nothing.
/// Errors are final: after one, next() yields nothing and feed() ignores its argument.
class FrameReader {
 public:
  /// `limit`: the largest payload accepted, in bytes (values above kMaxFramePayload mean kMaxFramePayload).
  explicit FrameReader(std::size_t limit);

  /// A new limit. Counts from the next call of next() on, also for frames fed already and for one that is
  /// incomplete, so a handler may change it between two frames of one piece.
  void setLimit(std::size_t limit);

  /// Hand over the next piece of the stream. The bytes must stay where they are until next() returned
  /// nothing: drain before feeding again (throws std::logic_error otherwise).
  void feed(std::string_view bytes);

  /// The next whole payload, or nothing. The view is valid until the next call of next() or feed(), and no
  /// longer than the bytes it was fed from.
  std::optional<std::string_view> next();

  FrameError error() const { return error_; }
  /// True if the stream may not end here: a part of a frame was received.
  bool midFrame() const { return !partial_.empty() && !yielded_; }
  /// Bytes of an incomplete frame kept in memory.
  std::size_t buffered() const { return partial_.size(); }

 private:
  void keep(std::size_t wanted);
  bool accept(std::size_t length);

  std::size_t limit_;
  std::string partial_;       // header and payload of a frame that arrives in pieces
  std::string_view pending_;  // the rest of the piece fed last
  bool yielded_ = false;      // partial_ is whole and was handed out; the next call forgets it
  FrameError error_ = FrameError::kNone;
};

/// Cuts a stream of bytes into messages, in the way that a TcpChannel needs: by lengths (LengthFraming), or
/// as a WebSocket (shared/net/http/WebSocketFraming.h). Reads and writes for one connection. No sockets, no
/// clock; not thread-safe.
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

/// Naiad's own: frames as above.
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
