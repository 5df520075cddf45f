#include <gtest/gtest.h>

#include "client/web/WebStreamOpener.h"
#include "shared/net/base/WebSocketProtocol.h"
#include "tests/client/web/FakePage.h"
#include "tests/shared/net/Recorder.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class WebStreamOpenerTest : public testing::Test, protected test::Recorder {
 protected:
  void open() {
    streams.open([this](std::unique_ptr<ReliableChannel> opened, const std::string& message) {
      channel = std::move(opened);
      error = message;
      ++done;
    });
  }
  void openAndStart() {
    open();
    streams.opened(page.newest);
    ASSERT_NE(channel, nullptr);
    channel->start(callbacks());
  }

  test::FakePage page;
  WebStreamOpener streams{page};
  std::unique_ptr<ReliableChannel> channel;
  std::string error;
  int done = 0;
};

TEST_F(WebStreamOpenerTest, AMessageIsAFrame) {
  openAndStart();
  streams.received(page.newest, "one");
  streams.received(page.newest, "two");
  EXPECT_EQ(frames, (std::vector<std::string>{"one", "two"}));
  streams.closed(page.newest, 1000, "");
  EXPECT_EQ(closed, CloseReason::kPeer);
  streams.received(page.newest, "three");
  EXPECT_EQ(frames.size(), 2u);
}

TEST_F(WebStreamOpenerTest, OversizedFrameEndsTheStream) {
  openAndStart();
  channel->setReceiveLimit(10);
  streams.received(page.newest, "0123456789");
  EXPECT_FALSE(closed);
  streams.received(page.newest, "01234567890");
  EXPECT_EQ(closed, CloseReason::kProtocol);
  EXPECT_TRUE(page.streams[page.newest].closed);
  EXPECT_EQ(frames.size(), 1u);
}

TEST_F(WebStreamOpenerTest, SilentGatewayTimesOut) {
  open();
  const WebStreamOpener::Time start{};
  streams.update(start);
  streams.update(start + WebStreamOpener::kOpenTimeout - 1ms);
  EXPECT_EQ(done, 0);
  streams.update(start + WebStreamOpener::kOpenTimeout);
  EXPECT_EQ(done, 1);
  EXPECT_EQ(channel, nullptr);
  EXPECT_FALSE(error.empty());
  EXPECT_TRUE(page.streams[page.newest].closed);
  streams.opened(page.newest);
  EXPECT_EQ(done, 1);
}

TEST_F(WebStreamOpenerTest, GatewayMessageIsShownSanitized) {
  open();
  streams.closed(page.newest, static_cast<int>(GatewayCloseCode::kUnreachable), "Nobody \033[2Jis there.");
  EXPECT_EQ(error, "Nobody ?[2Jis there.");
  EXPECT_EQ(streams.refusal(), error);
  EXPECT_FALSE(streams.closedDuringHandshake());
  EXPECT_FALSE(streams.isRefusalFinal());
  openAndStart();
  streams.received(page.newest, "news");
  EXPECT_TRUE(streams.refusal().empty());
}

TEST_F(WebStreamOpenerTest, FullGatewayIsTemporaryAndWrongKeyIsFinal) {
  open();
  streams.closed(page.newest, static_cast<int>(GatewayCloseCode::kFull), "Too many.");
  EXPECT_TRUE(streams.closedDuringHandshake());
  EXPECT_FALSE(streams.isRefusalFinal());
  openAndStart();
  streams.closed(page.newest, static_cast<int>(GatewayCloseCode::kWrongKey), "Another key.");
  EXPECT_TRUE(streams.isRefusalFinal());
  EXPECT_EQ(closed, CloseReason::kError);
}

TEST_F(WebStreamOpenerTest, TwoStreamsAreIndependent) {
  openAndStart();
  const int first = page.newest;
  std::unique_ptr<ReliableChannel> other;
  streams.openSecond(
      [&other](std::unique_ptr<ReliableChannel> opened, const std::string&) { other = std::move(opened); });
  streams.opened(page.newest);
  ASSERT_NE(other, nullptr);
  EXPECT_NE(first, page.newest);
  streams.closed(page.newest, 1006, "");
  EXPECT_FALSE(closed);
  other.reset();
  streams.received(first, "still here");
  EXPECT_EQ(frames.size(), 1u);
}

TEST_F(WebStreamOpenerTest, ChannelMayBeDestroyedInItsOwnCallback) {
  open();
  streams.opened(page.newest);
  channel->start({[this](std::string_view) { channel.reset(); }, callbacks().on_closed});
  streams.received(page.newest, "bye");
  EXPECT_TRUE(page.streams[page.newest].closed);
  streams.received(page.newest, "bye");
  EXPECT_FALSE(closed);
}

TEST_F(WebStreamOpenerTest, NewAttemptCancelsThePreviousOne) {
  open();
  const int first = page.newest;
  open();
  EXPECT_TRUE(page.streams[first].closed);
  streams.opened(first);
  EXPECT_EQ(done, 0);
  streams.opened(page.newest);
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace naiad
