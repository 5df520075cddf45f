// WebSocket frames read by a client: however the stream is split, the result is that of RFC 6455 for the
// whole stream, and at most a message is buffered. Written frames are masked and have the shortest form.
//
//   input   limit 2 | how it is split 1 | the stream
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "Target.h"
#include "shared/net/http/WebSocketFraming.h"

namespace naiad::fuzz {
namespace {

constexpr char kMaskByte = 0x55;

struct Outcome {
  std::vector<std::string> messages;
  std::optional<WebSocketClose> error;
  std::optional<std::uint16_t> close_code;
  std::string close_reason;
  std::optional<std::string> last_ping;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// The first frame in the bytes, written by a client or a server.
struct Frame {
  unsigned first = 0;
  bool is_masked = false;
  bool is_shortest = true;
  std::uint64_t length = 0;
  std::size_t header = 0;  ///< 0: the header is incomplete
};

Frame frameIn(std::string_view bytes) {
  if (bytes.size() < 2) return {};
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  Frame frame{at(0), (at(1) & 0x80) != 0, true, at(1) & 0x7fu, 2};
  const std::size_t more = frame.length == 126 ? 2 : frame.length == 127 ? 8 : 0;
  if (bytes.size() < 2 + more) return {frame.first, frame.is_masked};
  if (more == 0) return frame;
  frame.length = 0;
  for (std::size_t i = 0; i < more; ++i) frame.length = frame.length * 256 + at(2 + i);
  frame.is_shortest = more == 2 ? frame.length >= 126 : frame.length >= 65536;
  frame.header += more;
  return frame;
}

/// Reads the whole stream by the rules of RFC 6455.
Outcome expected(std::string_view stream, std::size_t limit) {
  Outcome outcome;
  std::optional<std::string> message;
  const auto fail = [&](WebSocketClose why) {
    outcome.error = why;
    return outcome;
  };
  while (stream.size() >= 2) {
    const Frame frame = frameIn(stream);
    if ((frame.first & 0x70) != 0 || frame.is_masked) return fail(WebSocketClose::kProtocolError);
    if (frame.header == 0) break;
    const bool is_last = (frame.first & 0x80) != 0;
    const unsigned opcode = frame.first & 0x0f;
    if (!frame.is_shortest || frame.length >> 63 != 0) return fail(WebSocketClose::kProtocolError);
    const bool is_control = opcode == 8 || opcode == 9 || opcode == 10;
    if (is_control && (!is_last || frame.length > 125)) return fail(WebSocketClose::kProtocolError);
    if (!is_control && opcode > 2) return fail(WebSocketClose::kProtocolError);
    if (!is_control && (opcode == 0) != message.has_value()) return fail(WebSocketClose::kProtocolError);
    if (opcode == 1) return fail(WebSocketClose::kUnsupportedData);
    if (!is_control && frame.length + (message ? message->size() : 0) > limit)
      return fail(WebSocketClose::kTooBig);
    if (stream.size() - frame.header < frame.length) break;
    const std::string payload(stream.substr(frame.header, static_cast<std::size_t>(frame.length)));
    stream.remove_prefix(frame.header + payload.size());
    if (opcode == 9) outcome.last_ping = payload;
    if (opcode == 8) {
      if (payload.size() == 1) return fail(WebSocketClose::kProtocolError);
      const int code = payload.empty() ? 1005
                                       : static_cast<unsigned char>(payload[0]) * 256 +
                                             static_cast<unsigned char>(payload[1]);
      const bool is_named = code >= 1000 && code <= 1014 && code != 1004 && code != 1006;
      if (!payload.empty() && (code == 1005 || (!is_named && (code < 3000 || code > 4999))))
        return fail(WebSocketClose::kProtocolError);
      outcome.close_code = static_cast<std::uint16_t>(code);
      if (!payload.empty()) outcome.close_reason = payload.substr(2);
      return outcome;
    }
    if (is_control) continue;
    message = message.value_or("") + payload;
    if (is_last) outcome.messages.push_back(*std::exchange(message, std::nullopt));
  }
  return outcome;
}

/// Returns the payload of the only frame in `bytes`, written by a client.
std::string writtenPayload(const std::string& bytes, unsigned first) {
  const Frame frame = frameIn(bytes);
  REQUIRE(frame.header > 0 && frame.first == first && frame.is_masked && frame.is_shortest);
  REQUIRE(bytes.size() == frame.header + 4 + frame.length);
  REQUIRE(bytes.substr(frame.header, 4) == std::string(4, kMaskByte));
  std::string payload = bytes.substr(frame.header + 4);
  for (char& c : payload) c = static_cast<char>(c ^ kMaskByte);
  return payload;
}

WebSocketFraming makeFraming(std::size_t limit) {
  return WebSocketFraming(limit, [] {
    return WebSocketFraming::Mask{kMaskByte, kMaskByte, kMaskByte, kMaskByte};
  });
}

Outcome cut(std::string_view stream, std::size_t limit, std::uint8_t how) {
  WebSocketFraming framing = makeFraming(limit);
  Outcome outcome;
  forEachPiece(stream, how, [&](std::string_view piece) {
    framing.feed(piece);
    while (const auto message = framing.next()) {
      REQUIRE(message->size() <= limit);
      outcome.messages.emplace_back(*message);
    }
    std::string reply;
    framing.appendReplies(reply);
    if (!reply.empty()) outcome.last_ping = writtenPayload(reply, 0x8a);
  });
  outcome.error = framing.error();
  outcome.close_code = framing.closeCode();
  outcome.close_reason = framing.closeReason();
  REQUIRE(framing.isBroken() == outcome.error.has_value());
  REQUIRE(framing.peerClosed().has_value() == outcome.close_code.has_value());

  std::string end;
  framing.appendEnd(end);
  const std::string code = writtenPayload(end, 0x88);
  REQUIRE(outcome.close_code == 1005 ? code.empty() : code.size() == 2);
  if (code.empty()) return outcome;
  const int sent = static_cast<unsigned char>(code[0]) * 256 + static_cast<unsigned char>(code[1]);
  const auto why = outcome.close_code.value_or(
      static_cast<std::uint16_t>(outcome.error.value_or(WebSocketClose::kNormal)));
  REQUIRE(sent == why);
  return outcome;
}

}  // namespace

void tryInput(Script script) {
  const std::size_t limit = script.number<std::uint16_t>();
  const std::uint8_t how = script.byte();
  const std::string stream = script.rest();
  const Outcome outcome = cut(stream, limit, how);
  REQUIRE(outcome == expected(stream, limit));

  WebSocketFraming writer = makeFraming(limit);
  for (const std::string& message : outcome.messages) {
    std::string written;
    writer.append(written, message);
    REQUIRE(writtenPayload(written, 0x82) == message);
  }
  if (limit % 64 == 0) {  // only for one input in 64, because it takes time
    std::string written;
    const std::string longest(0x10000, stream.empty() ? 'x' : stream[0]);
    writer.append(written, longest);
    REQUIRE(writtenPayload(written, 0x82) == longest);
  }
}

}  // namespace naiad::fuzz
