#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <string>
#include <vector>

#include "TcpFixture.h"
#include "shared/net/stream/Framing.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
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

TEST(IsLoopback, AcceptsOnlyLoopbackAddresses) {
  for (const char* here : {"127.0.0.1", "127.9.8.7", "::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(isLoopback(asio::ip::make_address(here))) << here;
  for (const char* there : {"0.0.0.0", "128.0.0.1", "10.0.0.1", "::", "::2", "fe80::1", "::ffff:8.8.8.8"})
    EXPECT_FALSE(isLoopback(asio::ip::make_address(there))) << there;
}

using TcpChannelEndTest = TcpFixture;
INSTANTIATE_TEST_SUITE_P(Channel, TcpChannelEndTest, testing::Values(Kind::kPlain, Kind::kTls), nameOf);

TEST_P(TcpChannelEndTest, CloseFlushesQueuedFramesEvenIfDestroyed) {
  for (const bool is_destroyed : {false, true}) {
    ChannelPair pair(context, GetParam());
    Recorder closer, reader;
    if (!is_destroyed) pair.near->start(closer.callbacks());
    pair.far->start(reader.callbacks());
    for (int i = 0; i < 50; ++i) pair.near->send(std::string(10'000, 'x'));
    pair.near->close();
    pair.near->send("too late");
    if (is_destroyed) pair.near.reset();
    EXPECT_TRUE(runUntil(context, [&] { return reader.closed && (is_destroyed || closer.closed); }));
    EXPECT_EQ(reader.frames.size(), 50u);
    EXPECT_EQ(reader.closed, CloseReason::kPeer);
    EXPECT_EQ(closer.closed == CloseReason::kLocal, !is_destroyed);
  }
}

TEST_P(TcpChannelEndTest, LastFrameReachesAPeerThatIsStillSending) {
  ChannelPair pair(context, GetParam());
  pair.near->start({nullptr, nullptr});
  pair.far->start(recorder.callbacks());
  for (int i = 0; i < 20; ++i) pair.far->send(std::string(10'000, 'x'));
  pair.near->send("goodbye");
  pair.near->close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"goodbye"s});
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_P(TcpChannelEndTest, CloseGivesUpWhenThePeerStopsReading) {
  connect({.close_timeout = 30ms});
  fillUp();
  channel->close();
  EXPECT_FALSE(recorder.closed);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
  EXPECT_EQ(peerReads(), ByteStream::Outcome::kBroken);  // a reset: the kernel keeps no unsent data
}

TEST_P(TcpChannelEndTest, OrderlyEndOfThePeerIsReportedOnce) {
  connect({});
  peerSends("\x05\0hello"s);
  peerEnds();
  EXPECT_TRUE(runUntilClosed());
  channel->close();
  runReady(context);
  EXPECT_EQ(recorder.frames, std::vector{"hello"s});
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
  EXPECT_EQ(recorder.closings, 1);
}

TEST_P(TcpChannelEndTest, FramesFromBeforeAResetAreStillDelivered) {
  connect({});
  peerSends("\x05\0hello"s);
  peerResets();
  channel->send("anyone?");  // fails before the frame is read
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"hello"s});
  EXPECT_EQ(recorder.closed, CloseReason::kError);
}

TEST_P(TcpChannelEndTest, SendingToAResetPeerClosesTheChannel) {
  connect({});
  peerResets();
  for (int i = 0; i < 10; ++i) channel->send("hello?");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kError);
  EXPECT_EQ(channel->unsentBytes(), 0u);
}

TEST_P(TcpChannelEndTest, MayBeDestroyedInItsFrameCallback) {
  ChannelPair pair(context, GetParam());
  int frames = 0;
  pair.far->start({[&, marker = std::string(100, 'm')](std::string_view) {
                     ++frames;
                     pair.far.reset();
                     EXPECT_EQ(marker.size(), 100u);  // the callback itself still exists
                   },
                   [](CloseReason) { FAIL() << "callback after destruction"; }});
  pair.near->start(recorder.callbacks());
  pair.near->send("one");
  pair.near->send("two");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(frames, 1);
}

TEST_P(TcpChannelEndTest, MayBeDestroyedInItsClosedCallback) {
  ChannelPair pair(context, GetParam());
  pair.far->start({nullptr, [&, marker = std::string(100, 'm')](CloseReason reason) {
                     pair.far.reset();
                     if (marker.size() == 100) recorder.closed = reason;
                   }});
  pair.near.reset();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_P(TcpChannelEndTest, NoFrameComesAfterTheHandlerClosed) {
  ChannelPair pair(context, GetParam());
  Recorder closer;
  pair.far->start({[&](std::string_view frame) {
                     closer.frames.emplace_back(frame);
                     pair.far->close();
                     EXPECT_FALSE(closer.closed);
                   },
                   [&](CloseReason reason) { closer.closed = reason; }});
  pair.near->start(recorder.callbacks());
  pair.near->send("one");
  pair.near->send("two");
  EXPECT_TRUE(runUntil(context, [&] { return closer.closed && recorder.closed; }));
  EXPECT_EQ(closer.frames, std::vector{"one"s});
  EXPECT_EQ(closer.closed, CloseReason::kLocal);
}

TEST_P(TcpChannelEndTest, EndBeforeStartIsReportedAfterStart) {
  makeChannel({.close_timeout = 1h});
  channel->close();
  peerEnds();
  runReady(context);
  channel->start(recorder.callbacks());
  EXPECT_FALSE(recorder.closed);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
}

TEST_P(TcpChannelEndTest, UnstartedClosedChannelEndsWithItsPeer) {
  makeChannel({.close_timeout = 1h});
  channel->close();
  channel.reset();
  peerEnds();
  EXPECT_TRUE(runUntil(context, [&] { return context.stopped(); }));  // no operation is pending
}

TEST_P(TcpChannelEndTest, PeerAddressIsKnownAfterTheEnd) {
  connect({});
  sockaddr_in local{};
  socklen_t size = sizeof local;
  ASSERT_EQ(getsockname(peer->socket().native_handle(), reinterpret_cast<sockaddr*>(&local), &size), 0);
  const std::string expected = "127.0.0.1:" + std::to_string(ntohs(local.sin_port));
  EXPECT_EQ(channel->peerAddress(), expected);
  peerEnds();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(channel->peerAddress(), expected);
}

TEST_P(TcpChannelEndTest, CloseReasonDependsOnHowThePeerEnded) {
  const std::vector<std::string> none, hello{"hello"};
  const CloseReason torn_off = encrypted() ? CloseReason::kError : CloseReason::kPeer;
  const struct {
    const char* name;
    std::string sent;
    void (TcpFixture::*end)();
    std::vector<std::string> frames;
    CloseReason reason;
  } rows[] = {
      {"a reset", "", &TcpFixture::peerResets, none, CloseReason::kError},
      {"within a frame", "\x05\0hel"s, &TcpFixture::peerEnds, none, CloseReason::kProtocol},
      {"without a word between frames", "\x05\0hello"s, &TcpFixture::peerVanishes, hello, torn_off},
      {"without a word within one", "\x05\0hel"s, &TcpFixture::peerVanishes, none, CloseReason::kProtocol},
      {"an empty frame", "\0\0"s, nullptr, none, CloseReason::kProtocol},
      {"an oversized frame", "\x05\0hello\1\4"s, nullptr, hello, CloseReason::kProtocol}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    channel.reset();
    recorder = {};
    connect({});
    peerSends(row.sent);
    if (row.end != nullptr) (this->*row.end)();
    EXPECT_TRUE(runUntilClosed());
    EXPECT_EQ(recorder.frames, row.frames);
    EXPECT_EQ(recorder.closed, row.reason);
  }
}

}  // namespace
}  // namespace naiad::test
