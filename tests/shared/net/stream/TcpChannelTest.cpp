#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <stdexcept>
#include <vector>

#include "TcpFixture.h"
#include "shared/net/stream/Framing.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using namespace std::string_literals;

using TcpChannelTest = TcpFixture;
INSTANTIATE_TEST_SUITE_P(Channel, TcpChannelTest, testing::Values(Kind::kPlain, Kind::kTls), nameOf);

TEST_P(TcpChannelTest, EchoedFramesComeBackWholeAndInOrder) {
  ChannelPair pair(context, GetParam());
  pair.far->start({[&](std::string_view frame) { pair.far->send(frame); }, nullptr});
  pair.near->start(recorder.callbacks());
  std::vector<std::string> sent;
  for (std::size_t size : {1u, 2u, 255u, 256u, 1448u, 16384u, 65535u})
    sent.emplace_back(size, 'a' + size % 26);
  for (const std::string& frame : sent) pair.near->send(frame);
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == sent.size(); }));
  EXPECT_EQ(recorder.frames, sent);
  EXPECT_FALSE(recorder.closed);
}

TEST_P(TcpChannelTest, MegabytesOfLargeFramesArriveUnchanged) {
  ChannelPair pair(context, GetParam(), {.send_cap = 64u << 20, .receive_limit = kMaxFramePayload});
  pair.far->start(recorder.callbacks());
  SplitMix64 rng(3);
  std::vector<std::string> sent;
  for (int i = 0; i < 200; ++i) {
    sent.emplace_back(kMaxFramePayload - rng.below(30000), '\0');
    for (char& c : sent.back()) c = static_cast<char>(rng.next());
    pair.near->send(sent.back());
  }
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == sent.size(); }));
  EXPECT_EQ(recorder.frames, sent);
  EXPECT_EQ(pair.near->unsentBytes(), 0u);
}

TEST_P(TcpChannelTest, SendsAtOnceAndKeepsTheKernelsQueueShort) {
  StreamPair streams = connectedStreams(context, GetParam());
  const int handle = streams.near->socket().native_handle();
  channel = makeTcpChannel(std::move(streams.near), {});
  int value = 0;
  socklen_t size = sizeof value;
  ASSERT_EQ(getsockopt(handle, IPPROTO_TCP, TCP_NODELAY, &value, &size), 0);
  EXPECT_NE(value, 0);
  if (getsockopt(handle, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &value, &size) != 0)
    GTEST_SKIP() << "this kernel has no TCP_NOTSENT_LOWAT";
  EXPECT_EQ(value, 4096);
}

TEST_P(TcpChannelTest, SlowReaderMakesUnsentBytesGrowAndThenOverflows) {
  constexpr std::size_t kCap = 300'000;
  connect({.send_cap = kCap});
  fillUp();
  const std::size_t full = channel->unsentBytes();
  channel->send(std::string(10'000, 'x'));
  EXPECT_EQ(channel->unsentBytes(), full + kFrameHeaderSize + 10'000);
  for (int i = 0; i < 100; ++i) {
    channel->send(std::string(10'000, 'x'));
    EXPECT_FALSE(recorder.closed);  // never called from within send()
    EXPECT_LE(channel->unsentBytes(), full + kCap);
  }
  EXPECT_EQ(channel->unsentBytes(), 0u);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kOverflow);
}

TEST_P(TcpChannelTest, UnsentBytesFallToZeroWhenReaderResumes) {
  connect({});
  fillUp();
  EXPECT_TRUE(runUntil(context, [&] {
    peerReads();
    return channel->unsentBytes() == 0;
  }));
  EXPECT_FALSE(recorder.closed);
}

TEST_P(TcpChannelTest, OversizedFrameIsAProtocolError) {
  connect({.receive_limit = 4});
  peerSends("\x04\0four\x05\0fives"s);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"four"s});
  EXPECT_EQ(recorder.closed, CloseReason::kProtocol);
}

TEST_P(TcpChannelTest, HandlerRaisesTheLimitForTheNextFrame) {
  makeChannel({.receive_limit = 4});
  channel->start({[&](std::string_view frame) {
                    recorder.frames.emplace_back(frame);
                    channel->setReceiveLimit(100);
                  },
                  nullptr});
  peerSends("\x04\0four\x05\0fives"s);
  EXPECT_TRUE(runUntil(context, [&] { return recorder.frames.size() == 2; }));
}

TEST_P(TcpChannelTest, SendRefusesInvalidSizes) {
  connect({});
  EXPECT_THROW(channel->send(""), std::length_error);
  EXPECT_THROW(channel->send(std::string(kMaxFramePayload + 1, 'x')), std::length_error);
}

TEST(IsLoopback, AcceptsOnlyLoopbackAddresses) {
  for (const char* here : {"127.0.0.1", "127.9.8.7", "::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(isLoopback(asio::ip::make_address(here))) << here;
  for (const char* there : {"0.0.0.0", "128.0.0.1", "10.0.0.1", "::", "::2", "fe80::1", "::ffff:8.8.8.8"})
    EXPECT_FALSE(isLoopback(asio::ip::make_address(there))) << there;
}

}  // namespace
}  // namespace naiad::test
