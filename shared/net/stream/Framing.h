// Frames on a byte stream, which separate its messages.
//
//   +----------------+----------------+---------------------+
//   | length, low 8  | length, high 8 | payload, length B   |   length = 1 … 65535, little-endian
//   +----------------+----------------+---------------------+
//
// Two bytes of length are enough: the largest frame that either end may send (Limits.h) has 16 KiB. A length
// of zero is invalid. A wrong size is a bug of the writer's caller. The reader trusts nothing: it checks the
// length before it stores any payload, and stores only received bytes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"

namespace naiad {

inline constexpr std::size_t kFrameHeaderSize = 2;
/// The largest payload that the length prefix can express, in bytes.
inline constexpr std::size_t kMaxFramePayload = 0xffff;

/// Appends header and payload to `out`. Throws std::length_error, and leaves `out` unchanged, if the payload
/// is empty or longer than kMaxFramePayload.
void appendFrame(std::string& out, std::string_view payload);

/// Writes the header of a payload of `length` bytes into the space before it. `length` is 1 …
/// kMaxFramePayload (asserted).
void writeFrameHeader(std::span<char, kFrameHeaderSize> into, std::size_t length);

/// The error that stopped a FrameReader.
enum class FrameError {
  kNone,
  kEmpty,     ///< a frame of length zero
  kTooLarge,  ///< a frame longer than the limit
};

/// Splits a stream of bytes, received in any pieces, into frames.
///
///   reader.feed(bytes);
///   while (auto frame = reader.next()) use(*frame);
///   if (reader.error() != FrameError::kNone) hangUp();
///
/// Memory: complete frames are not copied; the received bytes of an incomplete frame are stored, at most
/// header + limit. A peer that only announces a large frame costs nothing. Errors are final: after one,
/// next() returns nullopt and feed() ignores its argument.
class FrameReader {
 public:
  /// `limit`: the largest accepted payload in bytes, at most kMaxFramePayload.
  explicit FrameReader(std::size_t limit);

  /// Sets a new limit. It applies from the next call of next() on, also to bytes already fed, so a handler
  /// may change it between two frames of one piece.
  void setLimit(std::size_t limit);

  /// Adds the next piece of the stream. The bytes must stay valid until next() returned nullopt. Throws
  /// std::logic_error if the previous piece is not used up.
  void feed(std::string_view bytes);

  /// Returns the next complete payload, or nullopt. The view is valid until the next call of next() or
  /// feed(), and only as long as the bytes fed.
  std::optional<std::string_view> next();

  FrameError error() const { return error_; }
  /// True after a part of a frame: the stream may not end here.
  bool midFrame() const { return !partial_.empty() && !yielded_; }
  /// Returns the number of bytes of an incomplete frame in memory.
  std::size_t buffered() const { return partial_.size(); }

 private:
  void keep(std::size_t wanted);
  bool accept(std::size_t length);

  std::size_t limit_;
  std::string partial_;       // header and payload of a frame that arrives in pieces
  std::string_view pending_;  // the rest of the piece fed last
  bool yielded_ = false;      // partial_ is complete and was returned; the next call clears it
  FrameError error_ = FrameError::kNone;
};

/// Splits a stream of bytes into messages, for TcpChannel: by lengths (LengthFraming), or as a WebSocket
/// (shared/net/http/WebSocketFraming.h). One per connection. No sockets, no clock; not thread-safe.
class StreamFraming {
 public:
  virtual ~StreamFraming() = default;

  /// The largest payload accepted from the peer from now on, in bytes.
  virtual void setLimit(std::size_t bytes) = 0;
  /// Adds the next piece of the stream, which must stay valid until next() returned nullopt.
  virtual void feed(std::string_view bytes) = 0;
  /// Returns the next complete payload, or nullopt. It is valid until the next call of next() or feed().
  virtual std::optional<std::string_view> next() = 0;
  /// True after a protocol error of the peer; next() then always returns nullopt.
  virtual bool isBroken() const = 0;
  /// True after a part of a frame: the stream may not end here. May also be true before next() reads a frame.
  virtual bool midFrame() const = 0;
  /// Returns the reason to report if a frame announced that the peer closes; nothing is received after it.
  virtual std::optional<CloseReason> peerClosed() const { return std::nullopt; }

  /// Appends a frame with this payload to `out`. May throw std::length_error for an invalid size.
  virtual void append(std::string& out, std::string_view payload) = 0;
  /// Appends the framing's own answers to the frames that it read.
  virtual void appendReplies(std::string& /*out*/) {}
  /// Appends, once, the frame that announces the end, if the framing has one.
  virtual void appendEnd(std::string& /*out*/) {}
};

/// Naiad's own framing: FrameReader and appendFrame().
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
