// A ReliableChannel of WebSocket frames. Its peer is a bare stream that the test plays by hand.
#include <gtest/gtest.h>

#include "shared/net/http/WebSocketFraming.h"
#include "shared/net/stream/TcpChannel.h"
#include "tests/shared/net/stream/TcpFixture.h"

namespace naiad::test {
namespace {

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

TEST_P(WebSocketChannel, NormalCloseEndsOrderlyAndIsEchoed) {
  open();
  peerSends("\x82\x01z\x88\x02\x03\xe8");
  EXPECT_EQ(closed(), CloseReason::kPeer);
  EXPECT_EQ(recorder.frames, std::vector<std::string>{"z"});
  EXPECT_EQ(peerReads(8), "\x88\x82" + kZeroMask + "\x03\xe8");
}

TEST_P(WebSocketChannel, OtherCloseCodesAreErrorsAndEchoed) {
  open();
  peerSends("\x88\x02\x0f\xa0");
  EXPECT_EQ(closed(), CloseReason::kError);
  EXPECT_EQ(peerReads(8), "\x88\x82" + kZeroMask + "\x0f\xa0");
}

TEST_P(WebSocketChannel, ProtocolViolationIsAnsweredWithItsCloseCode) {
  open();
  peerSends("\x83\x01x");
  EXPECT_EQ(closed(), CloseReason::kProtocol);
  EXPECT_EQ(peerReads(8), "\x88\x82" + kZeroMask + "\x03\xea");
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
