// WebSocket frames read by a client: those that a server may send, in any pieces, and those that it must not
// send. A ReliableChannel of such frames, whose peer is a bare stream that the test plays by hand.
#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "shared/net/http/WebSocketFraming.h"
#include "shared/net/stream/TcpChannel.h"
#include "tests/shared/net/stream/TcpFixture.h"

namespace naiad::test {
namespace {

constexpr std::size_t kLimit = 1000;

WebSocketFraming makeFraming(std::size_t limit = kLimit) {
  return WebSocketFraming(limit, [] { return WebSocketFraming::Mask{'\x01', '\x02', '\x04', '\x08'}; });
}

/// Makes a frame of a server. `bits` is the first byte.
std::string frame(unsigned bits, std::string_view payload) {
  std::string bytes(1, static_cast<char>(bits));
  if (payload.size() > 125) {
    bytes += '\x7e';
    bytes += static_cast<char>(payload.size() >> 8);
    bytes += static_cast<char>(payload.size() & 0xff);
  } else {
    bytes += static_cast<char>(payload.size());
  }
  return bytes.append(payload);
}

struct Outcome {
  std::vector<std::string> messages;
  std::optional<WebSocketClose> error;
  std::optional<std::uint16_t> close_code;
  std::string reason;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

Outcome readPieces(const std::vector<std::string_view>& pieces, std::size_t limit) {
  WebSocketFraming framing = makeFraming(limit);
  Outcome outcome;
  for (const std::string_view piece : pieces) {
    framing.feed(std::string(piece));
    while (const auto message = framing.next()) outcome.messages.emplace_back(*message);
  }
  outcome.error = framing.error();
  outcome.close_code = framing.closeCode();
  outcome.reason = framing.closeReason();
  EXPECT_EQ(framing.isBroken(), outcome.error.has_value());
  return outcome;
}

/// Reads the stream at once, byte by byte, and split at each position. All results must be equal.
Outcome readStream(const std::string& stream, std::size_t limit = kLimit) {
  const std::string_view view = stream;
  const Outcome whole = readPieces({view}, limit);
  std::vector<std::string_view> bytes;
  for (std::size_t i = 0; i < view.size(); ++i) bytes.push_back(view.substr(i, 1));
  EXPECT_EQ(readPieces(bytes, limit), whole);
  for (std::size_t i = 0; i <= view.size() && view.size() < 2000; ++i)
    EXPECT_EQ(readPieces({view.substr(0, i), view.substr(i)}, limit), whole) << i;
  return whole;
}

std::string replies(WebSocketFraming& framing) {
  std::string out;
  framing.appendReplies(out);
  return out;
}

std::string unmasked(std::string payload) {
  for (std::size_t i = 0; i < payload.size(); ++i)
    payload[i] = static_cast<char>(payload[i] ^ (1 << (i % 4)));
  return payload;
}

const std::string kMask = "\x01\x02\x04\x08";

TEST(WebSocketFraming, ReadsLengthsOf64Bits) {
  const std::string payload(0x10000, 'x');
  const std::string header("\x82\x7f\0\0\0\0\0\1\0\0", 10);
  EXPECT_EQ(readStream(header + payload, payload.size()).messages, std::vector<std::string>{payload});
}

TEST(WebSocketFraming, JoinsFragmentsAndAnswersPingsBetweenThem) {
  const std::string stream = frame(0x02, "on") + frame(0x89, "ping") + frame(0x00, "") + frame(0x80, "e") +
                             frame(0x82, "two") + frame(0x02, "") + frame(0x80, "three");
  EXPECT_EQ(readStream(stream).messages, (std::vector<std::string>{"one", "two", "three"}));
  WebSocketFraming framing = makeFraming();
  framing.feed(std::string_view(stream).substr(0, 10));
  EXPECT_FALSE(framing.next());
  EXPECT_TRUE(framing.midFrame());
  EXPECT_EQ(replies(framing), "\x8a\x84" + kMask + unmasked("ping"));
  EXPECT_EQ(replies(framing), "") << "a ping is answered once";
}

TEST(WebSocketFraming, RefusesFramesServersMayNotSend) {
  const std::string long_ping(126, 'p');
  for (const std::string& stream :
       {frame(0xc2, "x"), frame(0xa2, "x"), frame(0x92, "x"), frame(0x83, "x"), frame(0x87, "x"),
        frame(0x8b, "x"), frame(0x8f, "x"), std::string("\x82\x81\1\2\3\4x"), frame(0x09, "x"),
        frame(0x08, ""), frame(0x89, long_ping), frame(0x80, "x"), frame(0x00, "x"),
        frame(0x02, "x") + frame(0x82, "y"), frame(0x02, "x") + frame(0x81, "y"),
        std::string("\x82\x7e\0\x7d", 4), std::string("\x82\x7f\0\0\0\0\0\0\xff\xff", 10),
        std::string("\x82\x7f\x80\0\0\0\0\0\0\0", 10)}) {
    const Outcome outcome = readStream(frame(0x82, "before") + stream + frame(0x82, "behind"));
    EXPECT_EQ(outcome.error, WebSocketClose::kProtocolError) << testing::PrintToString(stream);
    EXPECT_EQ(outcome.messages, std::vector<std::string>{"before"});
  }
  EXPECT_EQ(readStream(frame(0x81, "text")).error, WebSocketClose::kUnsupportedData);
}

TEST(WebSocketFraming, MessagesOverTheLimitAreRefusedByTheirHeader) {
  const std::string header("\x82\x7e\x03\xe9", 4);  // a length of 1001
  EXPECT_EQ(readStream(header).error, WebSocketClose::kTooBig);
  EXPECT_EQ(readStream(std::string("\x82\x7f\x7f\xff\xff\xff\xff\xff\xff\xff", 10)).error,
            WebSocketClose::kTooBig);
  const std::string half(kLimit / 2, 'x');
  EXPECT_EQ(readStream(frame(0x02, half) + frame(0x80, half)).messages.size(), 1U);
  EXPECT_EQ(readStream(frame(0x02, half) + frame(0x00, half) + std::string("\x80\x01")).error,
            WebSocketClose::kTooBig);
}

TEST(WebSocketFraming, LoweredLimitAppliesWithinAMessage) {
  WebSocketFraming framing = makeFraming();
  framing.feed(frame(0x02, "12345678"));
  EXPECT_FALSE(framing.next());
  framing.setLimit(4);
  framing.feed(frame(0x80, ""));
  EXPECT_FALSE(framing.next());
  EXPECT_EQ(framing.error(), WebSocketClose::kTooBig);
}

TEST(WebSocketFraming, ReadsCodeAndReasonOfAClose) {
  const Outcome outcome =
      readStream(frame(0x82, "x") + frame(0x88, "\x0f\xa0no server") + frame(0x82, "behind"));
  EXPECT_EQ(outcome.close_code, 4000);
  EXPECT_EQ(outcome.reason, "no server");
  EXPECT_EQ(outcome.messages, std::vector<std::string>{"x"});
  EXPECT_EQ(readStream(frame(0x88, "")).close_code, 1005);
}

TEST(WebSocketFraming, RefusesCloseCodesThatMayNotBeSent) {
  for (const int code : {0, 999, 1004, 1005, 1006, 1015, 1016, 2999, 5000, 65535}) {
    const std::string bytes{static_cast<char>(code >> 8), static_cast<char>(code & 0xff)};
    EXPECT_EQ(readStream(frame(0x88, bytes)).error, WebSocketClose::kProtocolError) << code;
  }
  EXPECT_EQ(readStream(frame(0x88, "\x03")).error, WebSocketClose::kProtocolError);
  for (const int code : {1000, 1001, 1003, 1007, 1014, 3000, 4999}) {
    const std::string bytes{static_cast<char>(code >> 8), static_cast<char>(code & 0xff)};
    EXPECT_EQ(readStream(frame(0x88, bytes)).close_code, code);
  }
}

TEST(WebSocketFraming, WritesMaskedMessagesWithTheShortestLength) {
  WebSocketFraming framing = makeFraming();
  for (const std::size_t size : {0, 1, 125, 126, 65535, 65536}) {
    std::string out;
    const std::string payload(size, 'a');
    framing.append(out, payload);
    const std::size_t extra = size <= 125 ? 0 : size <= 65535 ? 2 : 8;
    ASSERT_EQ(out.size(), 2 + extra + 4 + size);
    EXPECT_EQ(out[0], '\x82');
    EXPECT_EQ(static_cast<unsigned char>(out[1]), 0x80 | (extra == 0 ? size : extra == 2 ? 126U : 127U));
    EXPECT_EQ(out.substr(2 + extra, 4), kMask);
    EXPECT_EQ(unmasked(out.substr(6 + extra)), payload);
  }
}

TEST(WebSocketFraming, EachFrameGetsItsOwnMask) {
  int masks = 0;
  WebSocketFraming framing(kLimit, [&masks] {
    ++masks;
    return WebSocketFraming::Mask{};
  });
  std::string out;
  for (int i = 0; i < 3; ++i) framing.append(out, "x");
  EXPECT_EQ(masks, 3);
}

TEST(WebSocketFraming, ClosesOnceWithTheMatchingCode) {
  const auto code = [](std::string_view stream) {
    WebSocketFraming framing = makeFraming();
    framing.feed(stream);
    EXPECT_FALSE(framing.next());
    std::string out;
    framing.appendEnd(out);
    const std::string first = out;
    framing.appendEnd(out);
    EXPECT_EQ(out, first);
    EXPECT_EQ(out[0], '\x88');
    if (out.size() == 6) return 0;
    const std::string payload = unmasked(out.substr(6));
    return static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
  };
  EXPECT_EQ(code(""), 1000);
  EXPECT_EQ(code(frame(0x88, "\x0f\xa0why")), 4000);
  EXPECT_EQ(code(frame(0x88, "")), 0);
  EXPECT_EQ(code(frame(0x83, "")), 1002);
  EXPECT_EQ(code(frame(0x81, "")), 1003);
  EXPECT_EQ(code(std::string_view("\x82\x7f\0\0\0\1\0\0\0\0", 10)), 1009);
}

const std::string kZeroMask(4, '\0');

struct WebSocketChannel : TcpFixture {
  void open(std::string_view behind = {}) {
    StreamPair streams = connectedStreams(context, GetParam());
    peer = std::move(streams.far);
    auto framing = std::make_unique<WebSocketFraming>(100, [] { return WebSocketFraming::Mask{}; });
    framing->feed(behind);
    channel = makeFramedChannel(std::move(streams.near), std::move(framing));
    channel->start(recorder.callbacks());
  }
  /// Waits until the peer has received this many bytes.
  std::string peerReads(std::size_t count) {
    std::string all;
    EXPECT_TRUE(runUntil(context, [&] {
      std::array<char, 1000> buffer;
      const auto [outcome, size] = peer->read(buffer);
      if (outcome == ByteStream::Outcome::kDone) all.append(buffer.data(), size);
      return all.size() >= count;
    }));
    return all;
  }
  CloseReason closed() {
    EXPECT_TRUE(runUntilClosed());
    return recorder.closed.value_or(CloseReason::kLocal);
  }
};

TEST_P(WebSocketChannel, MessagesGoBothWays) {
  open(std::string_view("\x82\x01", 2));
  peerSends("a\x82\x02yz");
  channel->send("hello");
  EXPECT_EQ(peerReads(11), "\x82\x85" + kZeroMask + "hello");
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == 2; }));
  EXPECT_EQ(recorder.frames, (std::vector<std::string>{"a", "yz"}));
}

TEST_P(WebSocketChannel, BytesAfterTheUpgradeAnswerAreReadAtOnce) {
  open(
      "\x82\x05"
      "first");
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == 1; }));
}

TEST_P(WebSocketChannel, PingsAreAnswered) {
  open();
  peerSends("\x89\x02hi");
  EXPECT_EQ(peerReads(8), "\x8a\x82" + kZeroMask + "hi");
}

TEST_P(WebSocketChannel, EndIsAnsweredWithItsCloseCode) {
  const struct {
    const char* name;
    std::string sent, code;
    CloseReason reason;
  } rows[] = {{"a normal close", "\x88\x02\x03\xe8", "\x03\xe8", CloseReason::kPeer},
              {"another code", "\x88\x02\x0f\xa0", "\x0f\xa0", CloseReason::kError},
              {"a violation of the protocol", "\x83\x01x", "\x03\xea", CloseReason::kProtocol}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    channel.reset();
    recorder = {};
    open();
    peerSends("\x82\x01z" + row.sent);
    EXPECT_EQ(closed(), row.reason);
    EXPECT_EQ(recorder.frames, std::vector<std::string>{"z"});
    EXPECT_EQ(peerReads(8), "\x88\x82" + kZeroMask + row.code);
  }
}

TEST_P(WebSocketChannel, CloseSendsQueuedDataThenACloseFrame) {
  open();
  channel->send("x");
  channel->close();
  EXPECT_EQ(peerReads(15), "\x82\x81" + kZeroMask + "x\x88\x82" + kZeroMask + "\x03\xe8");
  peerSends("\x88\x02\x03\xe8");
  peer->end();
  peer->socket().close();
  EXPECT_EQ(closed(), CloseReason::kLocal);
}

TEST_P(WebSocketChannel, HasNoSharedSecret) {
  open();
  EXPECT_EQ(channel->exportSecret("label", "", 32), "") << "a gateway has the other end";
}

INSTANTIATE_TEST_SUITE_P(Channel, WebSocketChannel, testing::Values(Kind::kPlain, Kind::kTls), nameOf);

}  // namespace
}  // namespace naiad::test
