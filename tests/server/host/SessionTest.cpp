#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "Keyboard.h"
#include "Limits.h"
#include "Replica.h"
#include "Session.h"
#include "SimulatedWorld.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

/// What the channel did and was told; outlives the channel.
struct Wire {
  std::vector<std::string> sent;
  std::size_t unsent = 0;
  std::size_t receive_limit = 0;
  bool closed = false;
  ReliableChannel::Callbacks callbacks;
};

class FakeChannel : public ReliableChannel {
 public:
  explicit FakeChannel(Wire& wire) : m_wire(wire) {}
  void start(Callbacks callbacks) override { m_wire.callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    if (!m_wire.closed) m_wire.sent.emplace_back(frame);
  }
  std::size_t unsentBytes() const override { return m_wire.unsent; }
  void close() override { m_wire.closed = true; }
  std::string peerAddress() const override { return "fake:1"; }
  void setReceiveLimit(std::size_t bytes) override { m_wire.receive_limit = bytes; }

 private:
  Wire& m_wire;
};

class SessionTest : public testing::Test {
 protected:
  SessionTest() : session(std::make_unique<FakeChannel>(line), counters, now) {
    session.start({[this](Session& s, const wire::Hello& hello) {
                     if (hello.protocol() != kProtocolVersion) {
                       s.refuse(wire::Refused::VERSION, "Please update the client.");
                       return;
                     }
                     wire::Welcome welcome;
                     welcome.set_player(7);
                     welcome.set_name(hello.player_name());
                     s.welcome(welcome);
                   },
                   [this](Session&, const std::string& text) { chat.push_back(text); },
                   [this](Session&) { ++gone; }});
  }

  void hear(const wire::ClientMessage& message) { hearBytes(message.SerializeAsString()); }
  void hearBytes(const std::string& bytes) { line.callbacks.on_frame(bytes); }
  void greet(std::uint32_t protocol = kProtocolVersion, std::uint32_t magic = kHelloMagic) {
    wire::ClientMessage message;
    message.mutable_hello()->set_magic(magic);
    message.mutable_hello()->set_protocol(protocol);
    message.mutable_hello()->set_player_name("Ann");
    hear(message);
  }
  static wire::ClientMessage key(std::uint32_t id, std::uint32_t which = 0, std::uint32_t action = 0) {
    wire::ClientMessage message;
    message.mutable_input()->set_id(id);
    message.mutable_input()->mutable_key()->set_key(which);
    message.mutable_input()->mutable_key()->set_action(action);
    return message;
  }
  static wire::ClientMessage mouse(std::uint32_t action, std::uint32_t button, int x, int y) {
    wire::ClientMessage message;
    message.mutable_input()->set_id(1);
    message.mutable_input()->mutable_mouse()->set_action(action);
    message.mutable_input()->mutable_mouse()->set_button(button);
    message.mutable_input()->mutable_mouse()->set_x(x);
    message.mutable_input()->mutable_mouse()->set_y(y);
    return message;
  }
  static wire::ClientMessage says(const std::string& text) {
    wire::ClientMessage message;
    message.mutable_chat()->set_text(text);
    return message;
  }
  std::vector<std::uint32_t> takeInputs() {
    std::vector<std::uint32_t> ids;
    session.takeInputs([&ids](const wire::Input& input) { ids.push_back(input.id()); });
    return ids;
  }
  wire::ServerMessage lastSent() const {
    wire::ServerMessage message;
    EXPECT_FALSE(line.sent.empty());
    EXPECT_TRUE(line.sent.empty() || message.ParseFromString(line.sent.back()));
    return message;
  }
  bool ended() const { return session.state() == Session::State::kEnding && line.closed; }

  Session::Clock::time_point now{1000s};
  Wire line;
  Counters counters;
  std::vector<std::string> chat;
  int gone = 0;
  Session session;
};

TEST_F(SessionTest, IsWelcomedAfterItsHello) {
  EXPECT_EQ(line.receive_limit, kMaxHelloFrame);
  greet();
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  EXPECT_EQ(lastSent().welcome().player(), 7u);
  EXPECT_EQ(session.player(), 7u);
  EXPECT_EQ(session.name(), "Ann");
  EXPECT_EQ(line.receive_limit, kMaxClientFrame);
}

TEST_F(SessionTest, IsRefusedInWordsAndEnds) {
  greet(kProtocolVersion + 1);
  EXPECT_TRUE(ended());
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_EQ(lastSent().refused().reason(), wire::Refused::VERSION);
  EXPECT_EQ(lastSent().refused().sentence(), "Please update the client.");
  EXPECT_EQ(counters.malformed_messages, 0u);
}

TEST_F(SessionTest, EndsIfTheFirstMessageIsNoHello) {
  hear(key(1));
  EXPECT_TRUE(ended());
  EXPECT_TRUE(line.sent.empty());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(SessionTest, EndsIfTheMagicIsWrong) {
  greet(kProtocolVersion, 1);
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(SessionTest, EndsAtASecondHello) {
  greet();
  greet();
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(SessionTest, EndsAtBytesThatAreNoMessage) {
  greet();
  hearBytes("\xff\xff\xff");
  EXPECT_TRUE(ended());
  hear(says("still there?"));
  EXPECT_TRUE(chat.empty()) << "nothing is heard any more";
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(SessionTest, EndsAtAnEmptyMessage) {
  greet();
  hear({});
  EXPECT_TRUE(ended());
}

TEST_F(SessionTest, CountsABadFrameAndIsGone) {
  greet();
  line.callbacks.on_closed(CloseReason::kProtocol);
  EXPECT_EQ(session.state(), Session::State::kGone);
  EXPECT_EQ(counters.malformed_frames, 1u);
  EXPECT_EQ(gone, 1);
  const std::size_t sent = line.sent.size();
  session.goodbye("too late");
  EXPECT_EQ(line.sent.size(), sent);
}

TEST_F(SessionTest, InputsComeInOrderAtMost16ATick) {
  greet();
  for (std::uint32_t id = 1; id <= 20; ++id) hear(key(id));
  std::vector<std::uint32_t> first16;
  for (std::uint32_t id = 1; id <= 16; ++id) first16.push_back(id);
  EXPECT_EQ(takeInputs(), first16);
  EXPECT_EQ(takeInputs(), (std::vector<std::uint32_t>{17, 18, 19, 20}));
  EXPECT_TRUE(takeInputs().empty());
}

TEST_F(SessionTest, ARepeatedOrLateInputIsIgnoredAndCounted) {
  greet();
  for (const std::uint32_t id : {1u, 2u, 2u, 5u, 3u}) hear(key(id));
  EXPECT_EQ(takeInputs(), (std::vector<std::uint32_t>{1, 2, 5}));
  hear(key(5));
  EXPECT_TRUE(takeInputs().empty());
  EXPECT_EQ(counters.repeated_inputs, 3u);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(SessionTest, EndsAtMoreInputsThanTheQueueHolds) {
  greet();
  for (std::uint32_t id = 1; id <= Session::kMaxQueuedInputs; ++id) hear(key(id));
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  hear(key(Session::kMaxQueuedInputs + 1));
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().goodbye().sentence(), "Too many keys at once.");
  EXPECT_EQ(counters.input_floods, 1u);
}

TEST_F(SessionTest, InputsOfEveryKindAreTaken) {
  greet();
  hear(key(1, df::Keyboard::kKeyCount - 1, df::KEY_DOWN));
  wire::ClientMessage click = mouse(df::MOVED, df::Mouse::MIDDLE + 1, kMaxViewWidth - 1, kMaxViewHeight - 1);
  click.mutable_input()->set_id(2);
  hear(click);
  EXPECT_EQ(takeInputs().size(), 2u);
}

class BadInput : public SessionTest, public testing::WithParamInterface<int> {};

TEST_P(BadInput, EndsTheSession) {
  greet();
  wire::ClientMessage neither;
  neither.mutable_input()->set_id(1);
  const wire::ClientMessage bad[] = {
      key(0),
      key(1, df::Keyboard::kKeyCount),
      key(1, 0xFFFFFFFF),
      key(1, 0, df::KEY_DOWN + 1),
      mouse(df::MOVED + 1, 0, 0, 0),
      mouse(0, df::Mouse::MIDDLE + 2, 0, 0),
      mouse(0, 0, -1, 0),
      mouse(0, 0, 0, -1),
      mouse(0, 0, kMaxViewWidth, 0),
      mouse(0, 0, 0, kMaxViewHeight),
      neither,
  };
  ASSERT_EQ(std::size(bad), 11u);
  hear(bad[GetParam()]);
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
  EXPECT_TRUE(takeInputs().empty());
}

INSTANTIATE_TEST_SUITE_P(Session, BadInput, testing::Range(0, 11));

TEST_F(SessionTest, ChatIsCleanedAndThreeLinesASecond) {
  greet();
  for (int i = 0; i < 5; ++i) hear(says("  line\x1b " + std::to_string(i)));
  EXPECT_EQ(chat, (std::vector<std::string>{"line 0", "line 1", "line 2"}));
  EXPECT_EQ(counters.chat_dropped, 2u);
  session.checkDeadlines(now + 999ms);
  hear(says("too early"));
  session.checkDeadlines(now + 1s);
  hear(says("again"));
  EXPECT_EQ(chat.back(), "again");
  EXPECT_EQ(chat.size(), 4u);
}

TEST_F(SessionTest, ChatOfNothingCostsNothing) {
  greet();
  for (int i = 0; i < 5; ++i) hear(says(" \t "));
  hear(says("word"));
  EXPECT_EQ(chat, std::vector<std::string>{"word"});
}

TEST_F(SessionTest, AnswersPingsAndNotesTheRoundTrip) {
  greet();
  wire::ClientMessage ping;
  ping.mutable_ping()->set_token(0x123456789abcdef0);
  ping.mutable_ping()->set_rtt_millis(42);
  hear(ping);
  EXPECT_EQ(lastSent().pong().token(), 0x123456789abcdef0u);
  EXPECT_EQ(session.rttMillis(), 42u);
  ping.mutable_ping()->set_rtt_millis(0xFFFFFFFF);
  hear(ping);
  EXPECT_EQ(session.rttMillis(), 99'999u);
}

TEST_F(SessionTest, LeavingIsAnsweredAndEnds) {
  greet();
  wire::ClientMessage leave;
  leave.mutable_leave();
  hear(leave);
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().goodbye().sentence(), "You left the game.");
  EXPECT_EQ(gone, 1) << "at once";
  line.callbacks.on_closed(CloseReason::kLocal);
  EXPECT_EQ(gone, 1);
}

TEST_F(SessionTest, AResizeIsAccepted) {
  greet();
  wire::ClientMessage resize;
  resize.mutable_resize()->set_columns(0xFFFFFFFF);
  hear(resize);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(SessionTest, EndsWithoutAHelloInFiveSeconds) {
  session.checkDeadlines(now + 5s);
  EXPECT_EQ(session.state(), Session::State::kGreeting);
  session.checkDeadlines(now + 5s + 1ms);
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().refused().reason(), wire::Refused::BAD_REQUEST);
  EXPECT_EQ(counters.login_timeouts, 1u);
}

TEST_F(SessionTest, EndsAfterFifteenSecondsOfSilence) {
  greet();
  session.checkDeadlines(now + 10s);  // from here: the hello was heard before
  session.checkDeadlines(now + 25s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  hear(says("still here"));
  session.checkDeadlines(now + 25s + 1ms);
  session.checkDeadlines(now + 40s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  session.checkDeadlines(now + 40s + 2ms);
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.idle_timeouts, 1u);
  EXPECT_FALSE(lastSent().goodbye().sentence().empty());
  session.checkDeadlines(now + 99s);
  EXPECT_EQ(counters.idle_timeouts, 1u);
}

TEST_F(SessionTest, SkipsTicksWhileBytesAreUnsentAndCatchesUpAfter) {
  greet();
  test::SimulatedWorld world({}, 5);
  Publisher publisher;
  Replica replica;
  AckWindow acks;
  std::size_t read = line.sent.size();
  const auto tick = [&] {
    world.tick();
    publisher.update(world.view());
    session.sendTick(publisher, world.view().players[0]);
  };
  const auto receive = [&] {
    for (; read < line.sent.size(); ++read) {
      wire::ServerMessage message;
      ASSERT_TRUE(message.ParseFromString(line.sent[read]));
      ASSERT_TRUE(message.has_snapshot());
      const wire::Snapshot& snapshot = message.snapshot();
      const auto records = readRecords(snapshot.records(), snapshot.tick());
      ASSERT_TRUE(records);
      replica.apply(snapshot.number(), snapshot.tick(), *records);
      acks.note(snapshot.number());
    }
    wire::ClientMessage ack;
    ack.mutable_ack()->set_newest(acks.newest);
    ack.mutable_ack()->set_mask(acks.mask);
    hear(ack);
  };

  for (int round = 0; round < 20; ++round) {
    line.unsent = 1;
    const std::size_t before = line.sent.size();
    for (int i = 0; i < 25; ++i) tick();
    ASSERT_EQ(line.sent.size(), before);
    line.unsent = 0;
    for (int i = 0; i < 3; ++i) {  // slots that changed hands take a round trip more
      tick();
      receive();
    }
    world.tick(true);
    publisher.update(world.view());
    session.sendTick(publisher, world.view().players[0]);
    receive();
    const df::Canvas wanted = world.picture(0);
    const df::Canvas seen = replica.render(world.tickNumber());
    ASSERT_EQ(countDifferences(wanted, seen), 0) << "round " << round << "\n" << test::explain(wanted, seen);
  }
  EXPECT_EQ(counters.skipped_ticks, 20u * 25u);
  EXPECT_GT(counters.snapshots, 20u);
}

TEST_F(SessionTest, SnapshotsNameTheNewestInputThatReachedTheGame) {
  greet();
  test::SimulatedWorld world({}, 6);
  Publisher publisher;
  hear(key(1));
  hear(key(4));
  takeInputs();
  hear(key(5));
  world.tick();
  publisher.update(world.view());
  session.sendTick(publisher, world.view().players[0]);
  EXPECT_EQ(lastSent().snapshot().input_applied(), 4u);
}

}  // namespace
}  // namespace naiad
