#include "shared/net/http/WebSocketFraming.h"

#include <limits>
#include <utility>

namespace naiad {
namespace {

constexpr unsigned kContinuation = 0x0;
constexpr unsigned kBinary = 0x2;
constexpr unsigned kClose = 0x8;
constexpr unsigned kPing = 0x9;
constexpr unsigned kPong = 0xa;

constexpr unsigned kLastBit = 0x80;    // in the first byte
constexpr unsigned kMaskBit = 0x80;    // in the second byte
constexpr std::uint64_t kShort = 125;  // longest payload of control frames and of 7-bit lengths
constexpr unsigned kTwoBytes = 126;
constexpr unsigned kEightBytes = 127;

unsigned byteAt(std::string_view bytes, std::size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

bool isControl(unsigned opcode) {
  return opcode >= kClose;
}

std::uint64_t bigEndian(std::string_view bytes) {
  std::uint64_t number = 0;
  for (const char c : bytes) number = number << 8 | static_cast<unsigned char>(c);
  return number;
}

void appendBigEndian(std::string& out, std::uint64_t number, std::size_t bytes) {
  for (std::size_t i = bytes; i-- > 0;) out += static_cast<char>(number >> (8 * i) & 0xff);
}

/// True for a code that a close frame may contain (RFC 6455 7.4).
bool isCloseCode(std::uint64_t code) {
  return (code >= 1000 && code <= 1014 && code != 1004 && code != 1005 && code != 1006) ||
         (code >= 3000 && code <= 4999);
}

}  // namespace

void WebSocketFraming::feed(std::string_view bytes) {
  if (m_error || m_close_code) return;
  m_bytes.erase(0, m_at);
  m_at = 0;
  m_bytes.append(bytes);
}

std::optional<std::string_view> WebSocketFraming::next() {
  if (std::exchange(m_yielded, false)) m_message.clear();
  while (!m_error && !m_close_code) {
    const auto header = readHeader();
    if (!header || m_bytes.size() - m_at - header->size < header->length) return std::nullopt;
    const std::string_view payload =
        std::string_view(m_bytes).substr(m_at + header->size, static_cast<std::size_t>(header->length));
    m_at += header->size + payload.size();
    if (isControl(header->opcode)) {
      handleControl(*header, payload);
      continue;
    }
    const bool is_whole = header->is_last && !m_in_message;
    if (is_whole) return payload;
    m_in_message = !header->is_last;
    m_message.append(payload);
    if (m_in_message) continue;
    m_yielded = true;
    return m_message;
  }
  return std::nullopt;
}

/// Returns nullopt if the header is incomplete or was refused.
std::optional<WebSocketFraming::Header> WebSocketFraming::readHeader() {
  const std::string_view bytes = std::string_view(m_bytes).substr(m_at);
  if (bytes.size() < 2) return std::nullopt;
  const unsigned first = byteAt(bytes, 0);
  const unsigned second = byteAt(bytes, 1);
  Header header{(first & kLastBit) != 0, first & 0x0f, second & 0x7f, 2};
  const bool is_reserved = (first & 0x70) != 0;
  if (is_reserved || (second & kMaskBit) != 0) {
    fail(WebSocketClose::kProtocolError);
    return std::nullopt;
  }
  const std::size_t more = second == kTwoBytes ? 2 : second == kEightBytes ? 8 : 0;
  if (bytes.size() < header.size + more) return std::nullopt;
  if (more > 0) {
    header.length = bigEndian(bytes.substr(2, more));
    header.size += more;
    const bool is_shortest = header.length > (more == 2 ? kShort : 0xffff);
    if (!is_shortest || header.length > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) {
      fail(WebSocketClose::kProtocolError);
      return std::nullopt;
    }
  }
  if (!accept(header)) return std::nullopt;
  return header;
}

bool WebSocketFraming::accept(const Header& header) {
  const bool starts = header.opcode != kContinuation;
  if (isControl(header.opcode)) {
    const bool is_known = header.opcode <= kPong;
    if (!is_known || !header.is_last || header.length > kShort) fail(WebSocketClose::kProtocolError);
  } else if (header.opcode > kBinary || starts == m_in_message) {
    fail(WebSocketClose::kProtocolError);
  } else if (starts && header.opcode != kBinary) {
    fail(WebSocketClose::kUnsupportedData);
  } else if (header.length > m_limit || m_message.size() > m_limit - header.length) {
    fail(WebSocketClose::kTooBig);
  }
  return !m_error;
}

void WebSocketFraming::handleControl(const Header& header, std::string_view payload) {
  if (header.opcode == kPing) m_pong = payload;
  if (header.opcode == kClose) handleClose(payload);
}

void WebSocketFraming::handleClose(std::string_view payload) {
  if (payload.empty()) {
    m_close_code = static_cast<std::uint16_t>(WebSocketClose::kNoCode);
    return;
  }
  const std::uint64_t code = payload.size() < 2 ? 0 : bigEndian(payload.substr(0, 2));
  if (!isCloseCode(code)) return fail(WebSocketClose::kProtocolError);
  m_close_code = static_cast<std::uint16_t>(code);
  m_close_reason = payload.substr(2);
}

void WebSocketFraming::fail(WebSocketClose why) {
  m_error = why;
  m_at = 0;
  std::string().swap(m_bytes);
  std::string().swap(m_message);
}

std::optional<CloseReason> WebSocketFraming::peerClosed() const {
  if (!m_close_code) return std::nullopt;
  return *m_close_code == static_cast<std::uint16_t>(WebSocketClose::kNormal) ? CloseReason::kPeer
                                                                              : CloseReason::kError;
}

void WebSocketFraming::append(std::string& out, std::string_view payload) {
  appendFrame(out, kBinary, payload);
}

void WebSocketFraming::appendReplies(std::string& out) {
  if (m_pong) appendFrame(out, kPong, *m_pong);
  m_pong.reset();
}

void WebSocketFraming::appendEnd(std::string& out) {
  if (std::exchange(m_end_sent, true)) return;
  const auto code =
      m_close_code.value_or(static_cast<std::uint16_t>(m_error.value_or(WebSocketClose::kNormal)));
  std::string payload;
  if (code != static_cast<std::uint16_t>(WebSocketClose::kNoCode)) appendBigEndian(payload, code, 2);
  appendFrame(out, kClose, payload);
}

void WebSocketFraming::appendFrame(std::string& out, unsigned opcode, std::string_view payload) {
  out += static_cast<char>(kLastBit | opcode);
  if (payload.size() <= kShort) {
    out += static_cast<char>(kMaskBit | payload.size());
  } else if (payload.size() <= 0xffff) {
    out += static_cast<char>(kMaskBit | kTwoBytes);
    appendBigEndian(out, payload.size(), 2);
  } else {
    out += static_cast<char>(kMaskBit | kEightBytes);
    appendBigEndian(out, payload.size(), 8);
  }
  const Mask mask = m_mask();
  out.append(mask.data(), mask.size());
  for (std::size_t i = 0; i < payload.size(); ++i)
    out += static_cast<char>(payload[i] ^ mask[i % mask.size()]);
}

}  // namespace naiad
