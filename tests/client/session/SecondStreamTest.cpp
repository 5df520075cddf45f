// A second stream beside that of the session: when it is opened, what it may say, and what came twice.
#include <gtest/gtest.h>

#include "ClientSessionFixture.h"
#include "client/session/SecondStream.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Time = SecondStream::Time;

/// A channel to which a test can speak.
struct Line {
  std::vector<wire::ClientMessage> sent;
  ReliableChannel::Callbacks callbacks;
  std::size_t unsent = 0;
  bool destroyed = false;

  void say(const wire::ServerMessage& message) const {
    const auto on_frame = callbacks.on_frame;  // the callee may destroy the channel
    on_frame(message.SerializeAsString());
  }
};

class LineChannel : public ReliableChannel {
 public:
  explicit LineChannel(Line& line) : m_line(line) {}
  ~LineChannel() override { m_line.destroyed = true; }
  void start(Callbacks callbacks) override { m_line.callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    wire::ClientMessage message;
    ASSERT_TRUE(message.ParseFromArray(frame.data(), static_cast<int>(frame.size())));
    m_line.sent.push_back(message);
  }
  std::size_t unsentBytes() const override { return m_line.unsent; }
  void close() override {}
  std::string peerAddress() const override { return "fake"; }
  void setReceiveLimit(std::size_t) override {}

 private:
  Line& m_line;
};

class SecondStreamTest : public ClientSessionFixture {
 protected:
  SecondStreamTest() {
    SessionOptions options;
    options.resume_token = "token";
    options.second_stream = true;
    options.now = [this] { return now; };
    stream.start(std::make_unique<LineChannel>(line), options,
                 [this](std::string_view bytes) { snapshots.emplace_back(bytes); });
  }
  static wire::ServerMessage yes() {
    wire::ServerMessage message = welcomeMessage();
    message.mutable_welcome()->set_second_stream(true);
    return message;
  }

  Line line;
  std::vector<std::string> snapshots;
  SecondStream stream;
};

TEST_F(SecondStreamTest, SaysHelloAndWaitsForAYes) {
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_TRUE(line.sent[0].hello().second_stream());
  EXPECT_EQ(line.sent[0].hello().resume_token(), "token");
  stream.send("anything");
  EXPECT_EQ(line.sent.size(), 1u);
  EXPECT_FALSE(stream.isOpen());
  line.say(yes());
  EXPECT_TRUE(stream.isOpen());
  line.say(snapshotMessage(1, 1));
  EXPECT_EQ(snapshots.size(), 1u);
}

TEST_F(SecondStreamTest, AServerThatTookItForAnotherPlayersHelloLosesIt) {
  line.say(welcomeMessage());
  EXPECT_FALSE(stream.isOpen());
  EXPECT_TRUE(line.destroyed);
}

TEST_F(SecondStreamTest, NothingButSnapshotsComesOnIt) {
  wire::ServerMessage chat;
  chat.mutable_chat()->set_text("hello");
  for (const wire::ServerMessage& message : {snapshotMessage(1, 1), chat, yes(), wire::ServerMessage{}}) {
    Line other;
    SecondStream hears;
    hears.start(std::make_unique<LineChannel>(other), {},
                [this](std::string_view bytes) { snapshots.emplace_back(bytes); });
    if (!message.has_snapshot()) other.say(yes());
    other.say(message);
    EXPECT_FALSE(hears.isOpen()) << message.what_case();
    EXPECT_TRUE(other.destroyed);
  }
  EXPECT_TRUE(snapshots.empty()) << "none before the yes";
}

TEST_F(SecondStreamTest, WhatWaitsOnItIsNotWaitedFor) {
  line.say(yes());
  line.unsent = 1;
  stream.send(wire::ClientMessage().SerializeAsString());
  EXPECT_EQ(line.sent.size(), 1u);
  line.unsent = 0;
  stream.send(wire::ClientMessage().SerializeAsString());
  EXPECT_EQ(line.sent.size(), 2u);
}

TEST_F(SecondStreamTest, MayEndAtAnyTime) {
  line.say(yes());
  const auto on_closed = line.callbacks.on_closed;
  on_closed(CloseReason::kError);
  EXPECT_FALSE(stream.isOpen());
  stream.send("anything");
  stream.close();
}

TEST_F(SecondStreamTest, AttemptsThatFailBecomeSeldom) {
  SecondStream closed;
  int attempts = 0;
  Time now{1h};
  for (int i = 0; i < 600; ++i, now += 1s) attempts += closed.takeAttempt(now) ? 1 : 0;
  EXPECT_NEAR(attempts, 13, 2) << "2, 4, … 64 s, and then every 64 s";
  EXPECT_FALSE(stream.takeAttempt(now)) << "there is one";
}

TEST_F(SecondStreamTest, OneThatLastedMayBeReplacedSoon) {
  for (const auto& [lasts, attempts_then] : {std::pair{1s, 1}, {100s, 4}}) {
    SecondStream again;
    for (int i = 0; i < 600; ++i, now += 1s) again.takeAttempt(now);
    Line other;
    SessionOptions options;
    options.now = [this] { return now; };
    again.start(std::make_unique<LineChannel>(other), options, [](std::string_view) {});
    other.say(yes());
    now += lasts;
    other.say(snapshotMessage(1, 1));
    EXPECT_TRUE(again.isOpen());
    again.close();
    now += SecondStream::kLastPause;
    int attempts = 0;
    for (int i = 0; i < 20; ++i, now += 1s) attempts += again.takeAttempt(now) ? 1 : 0;
    EXPECT_EQ(attempts, attempts_then) << lasts.count() << " s";
  }
}

TEST_F(SecondStreamTest, OneThatIsSilentIsGivenUp) {
  now += SecondStream::kIdleTimer - 1ms;
  stream.update(now);
  EXPECT_FALSE(line.destroyed);
  line.say(yes());
  for (int i = 0; i < 5; ++i) {
    now += SecondStream::kIdleTimer - 1ms;
    stream.update(now);
    EXPECT_TRUE(stream.isOpen());
    line.say(snapshotMessage(1, 1));
  }
  now += SecondStream::kIdleTimer;
  stream.update(now);
  EXPECT_FALSE(stream.isOpen());
  EXPECT_TRUE(line.destroyed);
}

TEST_F(SecondStreamTest, KnowsTheLastSnapshotsAgain) {
  EXPECT_FALSE(stream.isRepeat("0"));
  for (int i = 1; i < 64; ++i) EXPECT_FALSE(stream.isRepeat(std::to_string(i)));
  for (int i = 0; i < 64; ++i) EXPECT_TRUE(stream.isRepeat(std::to_string(i)));
  EXPECT_FALSE(stream.isRepeat("64"));
  EXPECT_FALSE(stream.isRepeat("0")) << "long ago";
}

TEST_F(SecondStreamTest, ASessionWithoutDatagramsOfItsOwnWantsNone) {
  wire::ServerMessage message = welcomeMessage();
  message.mutable_welcome()->set_second_stream(true);
  receive(message);
  for (std::uint32_t i = 1; i < 300; ++i, now += 33ms) {
    snapshot(i, i);
    ASSERT_FALSE(session->wantsSecond(now));
  }
}

}  // namespace
}  // namespace naiad::test
