// WebSocket frames at the client's end (RFC 6455 5), without a socket: each binary message is a payload.
//
//   +--+---+------+-+-------+--------------------+------------+---------+
//   |F |RSV|opcode|M|length | length, 16 or 64   | mask,      | payload |   M: set only by the client;
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

/// Parses the frames of a server and writes those of a client.
///
/// Fragments are joined, up to the limit. A ping is answered by a pong; if several pings are read together,
/// only the last one (5.5.3). Protocol errors of the server: reserved bits or opcodes, a masked frame, a
/// length above 2^63 - 1 or not in its shortest form, a control frame that is fragmented or longer than 125
/// bytes, a continuation without a beginning, a message within a fragmented one, an invalid close code, a
/// text message, a message over the limit. Lengths are checked before the payload is stored.
///
/// Memory: one message up to the limit, and the bytes fed last.
class WebSocketFraming : public StreamFraming {
 public:
  using Mask = std::array<char, 4>;

  /// `limit`: largest message accepted, in bytes. `mask`: returns a new mask for each frame that is sent,
  /// unpredictable for servers and proxies (5.3, 10.3).
  WebSocketFraming(std::size_t limit, std::function<Mask()> mask) : m_limit(limit), m_mask(std::move(mask)) {}

  void setLimit(std::size_t bytes) override { m_limit = bytes; }
  void feed(std::string_view bytes) override;
  std::optional<std::string_view> next() override;
  bool isBroken() const override { return m_error.has_value(); }
  bool midFrame() const override { return m_at < m_bytes.size() || m_in_message; }
  /// Returns kPeer after a close frame with code 1000 (normal), kError after another; nullopt before both.
  std::optional<CloseReason> peerClosed() const override;

  /// Appends a binary message of one frame, at most 2^63 - 1 bytes.
  void append(std::string& out, std::string_view payload) override;
  void appendReplies(std::string& out) override;
  /// Appends a close frame with the peer's code if the peer closed first, else with error(), else with 1000.
  void appendEnd(std::string& out) override;

  /// The code of the peer's close frame, kNoCode if it has none; nullopt before that frame.
  std::optional<std::uint16_t> closeCode() const { return m_close_code; }
  /// The text of the peer's close frame: at most 123 bytes, unchecked.
  const std::string& closeReason() const { return m_close_reason; }
  /// The reason why the peer's bytes are no longer read.
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
  void handleControl(const Header& header, std::string_view payload);
  void handleClose(std::string_view payload);
  void appendFrame(std::string& out, unsigned opcode, std::string_view payload);
  void fail(WebSocketClose why);

  std::size_t m_limit;
  std::function<Mask()> m_mask;
  std::string m_bytes;  // fed bytes; unread from m_at on
  std::size_t m_at = 0;
  std::string m_message;  // fragments so far
  bool m_in_message = false;
  bool m_yielded = false;  // m_message was returned; the next call clears it
  std::optional<std::string> m_pong;
  std::optional<std::uint16_t> m_close_code;
  std::string m_close_reason;
  std::optional<WebSocketClose> m_error;
  bool m_end_sent = false;
};

}  // namespace naiad
