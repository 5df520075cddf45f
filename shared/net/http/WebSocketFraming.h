// Frames of a WebSocket at a client's end (RFC 6455 5), without its socket: each binary message is a payload.
//
//   +--+---+------+-+-------+--------------------+------------+---------+
//   |F |RSV|opcode|M|length | length, 16 or 64   | mask,      | payload |   M: set by the client alone;
//   |IN| 0 |4 bits| |7 bits | bits (126, 127)    | 4 bytes (M)|         |   numbers are big-endian
//   +--+---+------+-+-------+--------------------+------------+---------+
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "shared/net/stream/Framing.h"

namespace naiad {

/// Codes of RFC 6455 7.4.1 that this end sends.
enum class WebSocketClose : std::uint16_t {
  kNormal = 1000,
  kProtocolError = 1002,
  kUnsupportedData = 1003,  ///< a text message: only binary ones are expected
  kTooBig = 1009,
  kNoCode = 1005,  ///< stands for a close frame without a code; never sent
};

/// Reads what a server sends and writes what a client sends.
///
/// Fragments are put together up to the limit. A ping is answered by a pong; of pings that are read together,
/// the last one (5.5.3). A server breaks the rules with: reserved bits or opcodes, a masked frame, a length
/// not in its shortest form, a control frame that is fragmented or longer than 125 bytes, a continuation of
/// nothing, a message within a fragmented one, a close code that may not be sent, a text message, a message
/// over the limit. Lengths are checked before any of the payload is kept.
///
/// Memory: one message up to the limit, and the bytes fed last.
class WebSocketFraming : public StreamFraming {
 public:
  using Mask = std::array<char, 4>;

  /// `limit`: largest message accepted, in bytes. `mask`: returns a new mask for each frame that is sent,
  /// which servers and those between cannot predict (5.3, 10.3).
  WebSocketFraming(std::size_t limit, std::function<Mask()> mask) : m_limit(limit), m_mask(std::move(mask)) {}

  void setLimit(std::size_t bytes) override { m_limit = bytes; }
  void feed(std::string_view bytes) override;
  std::optional<std::string_view> next() override;
  bool isBroken() const override { return m_error.has_value(); }
  bool midFrame() const override { return m_at < m_bytes.size() || m_in_message; }
  /// kPeer for the code 1000 (normal), kError for all others.
  std::optional<CloseReason> peerClosed() const override;

  /// A binary message of one frame, at most 2^63 - 1 bytes.
  void append(std::string& out, std::string_view payload) override;
  void appendReplies(std::string& out) override;
  /// A close frame: with the peer's code if it closed first, else why it is not listened to any more, else
  /// 1000.
  void appendEnd(std::string& out) override;

  /// The code of the close frame that the peer sent; nullopt before.
  std::optional<std::uint16_t> closeCode() const { return m_close_code; }
  /// The text of that frame: at most 123 bytes of the peer, not checked.
  const std::string& closeReason() const { return m_close_reason; }
  /// The reason why the peer is not read any more.
  std::optional<WebSocketClose> error() const { return m_error; }

 private:
  struct Header {
    bool is_last = false;
    unsigned opcode = 0;
    std::uint64_t length = 0;
    std::size_t size = 0;  // bytes of the header
  };

  std::optional<Header> readHeader();
  bool accept(const Header& header);
  void takeControl(const Header& header, std::string_view payload);
  void takeClose(std::string_view payload);
  void appendFrame(std::string& out, unsigned opcode, std::string_view payload);
  void fail(WebSocketClose why);

  std::size_t m_limit;
  std::function<Mask()> m_mask;
  std::string m_bytes;  // fed, from m_at on not read yet
  std::size_t m_at = 0;
  std::string m_message;  // fragments so far
  bool m_in_message = false;
  bool m_yielded = false;  // m_message was handed out; the next call forgets it
  std::optional<std::string> m_pong;
  std::optional<std::uint16_t> m_close_code;
  std::string m_close_reason;
  std::optional<WebSocketClose> m_error;
  bool m_end_sent = false;
};

}  // namespace naiad
