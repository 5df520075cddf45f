// The second stream of a session: when it opens, which messages it may carry, and how duplicates are dropped.
#include <gtest/gtest.h>

#include "ClientSessionFixture.h"
#include "client/session/ServerLink.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Time = SecondStream::Time;

class SecondStreamTest : public ClientSessionFixture {
 protected:
  SecondStreamTest() {
    SessionOptions options;
    options.resume_token = "token";
    options.second_stream = true;
    options.now = [this] { return now; };
    stream.start(std::make_unique<FakeChannel>(line), options,
                 [this](std::string_view bytes) { snapshots.emplace_back(bytes); });
  }
  static wire::ServerMessage yes() {
    wire::ServerMessage message = welcomeMessage();
    message.mutable_welcome()->set_second_stream(true);
    return message;
  }

  MessageLine<wire::ClientMessage> line;
  std::vector<std::string> snapshots;
  SecondStream stream;
};

TEST_F(SecondStreamTest, SaysHelloAndWaitsForTheWelcome) {
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_TRUE(line.sent[0].hello().second_stream());
  EXPECT_EQ(line.sent[0].hello().resume_token(), "token");
  stream.send("anything");
  EXPECT_EQ(line.sent.size(), 1u);
  EXPECT_FALSE(stream.isOpen());
  line.receive(yes());
  EXPECT_TRUE(stream.isOpen());
  line.receive(snapshotMessage(1, 1));
  EXPECT_EQ(snapshots.size(), 1u);
}

TEST_F(SecondStreamTest, AWelcomeToANewPlayerClosesIt) {
  line.receive(welcomeMessage());
  EXPECT_FALSE(stream.isOpen());
  EXPECT_TRUE(line.destroyed);
}

TEST_F(SecondStreamTest, OnlySnapshotsAreAcceptedOnIt) {
  wire::ServerMessage chat;
  chat.mutable_chat()->set_text("hello");
  for (const wire::ServerMessage& message : {snapshotMessage(1, 1), chat, yes(), wire::ServerMessage{}}) {
    MessageLine<wire::ClientMessage> other;
    SecondStream second;
    second.start(std::make_unique<FakeChannel>(other), {},
                 [this](std::string_view bytes) { snapshots.emplace_back(bytes); });
    if (!message.has_snapshot()) other.receive(yes());
    other.receive(message);
    EXPECT_FALSE(second.isOpen()) << message.payload_case();
    EXPECT_TRUE(other.destroyed);
  }
  EXPECT_TRUE(snapshots.empty()) << "none before the yes";
}

TEST_F(SecondStreamTest, NothingIsSentWhileBytesWaitOnIt) {
  line.receive(yes());
  line.unsent = 1;
  stream.send(wire::ClientMessage().SerializeAsString());
  EXPECT_EQ(line.sent.size(), 1u);
  line.unsent = 0;
  stream.send(wire::ClientMessage().SerializeAsString());
  EXPECT_EQ(line.sent.size(), 2u);
}

TEST_F(SecondStreamTest, SendAndCloseAfterItsEndAreHarmless) {
  line.receive(yes());
  const auto on_closed = line.callbacks.on_closed;
  on_closed(CloseReason::kError);
  EXPECT_FALSE(stream.isOpen());
  stream.send("anything");
  stream.close();
}

TEST_F(SecondStreamTest, FailedAttemptsBackOffExponentially) {
  SecondStream closed;
  int attempts = 0;
  Time time{1h};
  for (int i = 0; i < 600; ++i, time += 1s) attempts += closed.tryBeginAttempt(time) ? 1 : 0;
  EXPECT_NEAR(attempts, 13, 2) << "2, 4, … 64 s, and then every 64 s";
  EXPECT_FALSE(stream.tryBeginAttempt(time)) << "there is one";
}

TEST_F(SecondStreamTest, LongLivedStreamResetsTheRetryDelay) {
  for (const auto& [lasts, attempts_then] : {std::pair{1s, 1}, {100s, 4}}) {
    MessageLine<wire::ClientMessage> other;
    SecondStream again;
    for (int i = 0; i < 600; ++i, now += 1s) again.tryBeginAttempt(now);
    SessionOptions options;
    options.now = [this] { return now; };
    again.start(std::make_unique<FakeChannel>(other), options, [](std::string_view) {});
    other.receive(yes());
    now += lasts;
    other.receive(snapshotMessage(1, 1));
    EXPECT_TRUE(again.isOpen());
    again.close();
    now += SecondStream::kMaxRetryDelay;
    int attempts = 0;
    for (int i = 0; i < 20; ++i, now += 1s) attempts += again.tryBeginAttempt(now) ? 1 : 0;
    EXPECT_EQ(attempts, attempts_then) << lasts.count() << " s";
  }
}

TEST_F(SecondStreamTest, SilentStreamTimesOut) {
  now += SecondStream::kMaxSilence - 1ms;
  stream.update(now);
  EXPECT_FALSE(line.destroyed);
  line.receive(yes());
  for (int i = 0; i < 5; ++i) {
    now += SecondStream::kMaxSilence - 1ms;
    stream.update(now);
    EXPECT_TRUE(stream.isOpen());
    line.receive(snapshotMessage(1, 1));
  }
  now += SecondStream::kMaxSilence;
  stream.update(now);
  EXPECT_FALSE(stream.isOpen());
  EXPECT_TRUE(line.destroyed);
}

TEST_F(SecondStreamTest, RecognisesRepeatedSnapshots) {
  EXPECT_FALSE(stream.isDuplicate("0"));
  for (int i = 1; i < 64; ++i) EXPECT_FALSE(stream.isDuplicate(std::to_string(i)));
  for (int i = 0; i < 64; ++i) EXPECT_TRUE(stream.isDuplicate(std::to_string(i)));
  EXPECT_FALSE(stream.isDuplicate("64"));
  EXPECT_FALSE(stream.isDuplicate("0")) << "long ago";
}

TEST_F(SecondStreamTest, SessionWithoutDatagramKeysWantsNoSecondStream) {
  receive(yes());
  for (std::uint32_t i = 1; i < 300; ++i, now += 33ms) {
    snapshot(i, i);
    ASSERT_FALSE(session->shouldOpenSecondStream(now));
  }
}

}  // namespace
}  // namespace naiad::test
