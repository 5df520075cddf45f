// How a TcpChannel ends, and what may happen to it meanwhile.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "TcpChannel.h"
#include "TcpFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;

using TcpChannelEndTest = TcpFixture;

TEST_F(TcpChannelEndTest, CloseFlushesWhatIsQueued) {
  ChannelPair pair(context);
  Recorder closer;
  pair.near->start(closer.callbacks());
  pair.far->start(recorder.callbacks());
  for (int i = 0; i < 50; ++i) pair.near->send(std::string(10'000, 'x'));
  pair.near->close();
  pair.near->send("too late");
  EXPECT_TRUE(runUntil(context, [&] { return recorder.closed && closer.closed; }));
  EXPECT_EQ(recorder.frames.size(), 50u);
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
  EXPECT_EQ(closer.closed, CloseReason::kLocal);
}

TEST_F(TcpChannelEndTest, DestroyedAfterCloseItStillFlushes) {
  ChannelPair pair(context);
  pair.far->start(recorder.callbacks());
  for (int i = 0; i < 50; ++i) pair.near->send(std::string(10'000, 'x'));
  pair.near->close();
  pair.near.reset();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames.size(), 50u);
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_F(TcpChannelEndTest, LastWordsSurviveAPeerThatWasStillTalking) {
  ChannelPair pair(context);
  pair.near->start({nullptr, nullptr});
  pair.far->start(recorder.callbacks());
  for (int i = 0; i < 20; ++i) pair.far->send(std::string(10'000, 'x'));
  pair.near->send("goodbye");
  pair.near->close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"goodbye"s});
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_F(TcpChannelEndTest, CloseGivesUpOnAPeerThatDoesNotRead) {
  connect({.close_timeout = 30ms});
  fillUp();
  channel->close();
  EXPECT_FALSE(recorder.closed);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
  std::vector<char> sink(1 << 20);
  std::error_code error;
  while (!error) peer.read_some(asio::buffer(sink), error);
  EXPECT_EQ(error, asio::error::connection_reset);  // and the kernel keeps nothing for it
}

TEST_F(TcpChannelEndTest, DestroyingWithoutCloseHangsUp) {
  ChannelPair pair(context);
  pair.far->start(recorder.callbacks());
  pair.near.reset();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
}

TEST_F(TcpChannelEndTest, OrderlyEndOfThePeerIsReportedOnce) {
  connect({});
  peerSends("\x05\0hello"s);
  peer.close();
  EXPECT_TRUE(runUntilClosed());
  channel->close();
  runReady(context);
  EXPECT_EQ(recorder.frames, std::vector{"hello"s});
  EXPECT_EQ(recorder.closed, CloseReason::kPeer);
  EXPECT_EQ(recorder.closings, 1);
}

TEST_F(TcpChannelEndTest, ResetByThePeerIsAnError) {
  connect({});
  peer.set_option(tcp::socket::linger(true, 0));
  peer.close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kError);
}

TEST_F(TcpChannelEndTest, FramesFromBeforeAResetAreStillDelivered) {
  connect({});
  peerSends("\x05\0hello"s);
  peer.set_option(tcp::socket::linger(true, 0));
  peer.close();
  channel->send("anyone?");  // fails before the frame is read
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.frames, std::vector{"hello"s});
  EXPECT_EQ(recorder.closed, CloseReason::kError);
}

TEST_F(TcpChannelEndTest, SendingToAPeerThatWentAwayEndsTheChannel) {
  connect({});
  peer.set_option(tcp::socket::linger(true, 0));
  peer.close();
  for (int i = 0; i < 10; ++i) channel->send("hello?");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kError);
  EXPECT_EQ(channel->unsentBytes(), 0u);
}

TEST_F(TcpChannelEndTest, StreamThatEndsWithinAFrameBreaksTheProtocol) {
  connect({});
  peerSends("\x05\0hel"s);
  peer.close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_TRUE(recorder.frames.empty());
  EXPECT_EQ(recorder.closed, CloseReason::kProtocol);
}

TEST_F(TcpChannelEndTest, MayBeDestroyedInItsFrameCallback) {
  ChannelPair pair(context);
  int frames = 0;
  pair.far->start({[&, marker = std::string(100, 'm')](std::string_view) {
                     ++frames;
                     pair.far.reset();
                     EXPECT_EQ(marker.size(), 100u);  // the callback itself is still alive
                   },
                   [](CloseReason) { FAIL() << "callback after destruction"; }});
  pair.near->start(recorder.callbacks());
  pair.near->send("one");
  pair.near->send("two");
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(frames, 1);
}

TEST_F(TcpChannelEndTest, MayBeDestroyedInItsClosedCallback) {
  connect({});
  ChannelPair pair(context);
  bool closed = false;
  pair.far->start({nullptr, [&, marker = std::string(100, 'm')](CloseReason) {
                     pair.far.reset();
                     closed = marker.size() == 100;
                   }});
  pair.near.reset();
  EXPECT_TRUE(runUntil(context, [&] { return closed; }));
}

TEST_F(TcpChannelEndTest, NoFrameComesAfterTheHandlerClosed) {
  ChannelPair pair(context);
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

TEST_F(TcpChannelEndTest, EndBeforeStartIsReportedAfterStart) {
  SocketPair sockets = connectedSockets(context);
  channel = makeTcpChannel(std::move(sockets.near), {.close_timeout = 1h});
  channel->close();
  sockets.far.close();
  runReady(context);
  channel->start(recorder.callbacks());
  EXPECT_FALSE(recorder.closed);
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(recorder.closed, CloseReason::kLocal);
}

TEST_F(TcpChannelEndTest, ClosedBeforeStartItIsGoneWhenThePeerIs) {
  SocketPair sockets = connectedSockets(context);
  channel = makeTcpChannel(std::move(sockets.near), {.close_timeout = 1h});
  channel->close();
  channel.reset();
  sockets.far.close();
  EXPECT_TRUE(runUntil(context, [&] { return context.stopped(); }));  // nothing left to wait for
}

TEST_F(TcpChannelEndTest, KnowsItsPeersAddressAfterTheEndToo) {
  connect({});
  const std::string expected = "127.0.0.1:" + std::to_string(peer.local_endpoint().port());
  EXPECT_EQ(channel->peerAddress(), expected);
  peer.close();
  EXPECT_TRUE(runUntilClosed());
  EXPECT_EQ(channel->peerAddress(), expected);
}

}  // namespace
}  // namespace naiad::test
