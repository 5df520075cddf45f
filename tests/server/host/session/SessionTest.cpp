#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "host/session/Session.h"
#include "shared/values/Keyboard.h"
#include "tests/server/host/rooms/Clients.h"
#include "tests/server/host/snapshot/DirectSender.h"
#include "tests/server/host/snapshot/SimulatedWorld.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

using test::FakeChannel;
using Wire = test::Client;

class SessionTest : public testing::Test {
 protected:
  SessionTest() : session(std::make_unique<FakeChannel>(line), counters, now) {
    session.start({[](Session& s, const wire::Hello& hello) {
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
                   [this](Session&) { ++gone; }, [this] { return now; }});
  }

  void hearBytes(const std::string& bytes) { line.callbacks.on_frame(bytes); }
  /// Calls checkDeadlines() until `after` has passed since `now`. Begins where the last call ended.
  void listenUntil(Session& listener, Session::Clock::duration after) {
    for (; listened < after; listened += 100ms) listener.checkDeadlines(now + listened);
    listened = after;
    listener.checkDeadlines(now + after);
  }
  static wire::ClientMessage hello(std::uint32_t protocol = kProtocolVersion,
                                   std::uint32_t magic = kHelloMagic) {
    wire::ClientMessage message;
    *message.mutable_hello() = test::helloOf("Ann");
    message.mutable_hello()->set_magic(magic);
    message.mutable_hello()->set_protocol(protocol);
    return message;
  }
  void greet() { line.receive(hello()); }
  static wire::ClientMessage inputs(std::vector<Input> inputs) {
    ClientUpdate update;
    update.inputs = std::move(inputs);
    wire::ClientMessage message;
    message.set_update(writeUpdate(update));
    return message;
  }
  static Input keyInput(std::uint32_t id, int which = 0) {
    return {.id = id, .key = static_cast<std::uint8_t>(which)};
  }
  std::vector<std::uint32_t> drainInputs(std::uint32_t tick = 1) {
    std::vector<std::uint32_t> ids;
    session.drainInputs(tick, [&ids](const Input& input) { ids.push_back(input.id); });
    return ids;
  }
  wire::ServerMessage lastSent() const {
    EXPECT_FALSE(line.sent.empty());
    return line.sent.empty() ? wire::ServerMessage() : line.sent.back();
  }
  bool ended() const { return session.state() == Session::State::kEnding && line.closed; }

  Session::Clock::time_point now{1000s};
  Wire line;
  Counters counters;
  std::vector<std::string> chat;
  int gone = 0;
  Session session;
  Session::Clock::duration listened{};  ///< time passed in listenUntil()
};

/// A session whose client has been welcomed.
class PlayingSessionTest : public SessionTest {
 protected:
  PlayingSessionTest() { greet(); }
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

TEST_F(SessionTest, RefusalHasAMessageAndEndsTheSession) {
  line.receive(hello(kProtocolVersion + 1));
  EXPECT_TRUE(ended());
  ASSERT_EQ(line.sent.size(), 1u);
  EXPECT_EQ(lastSent().refused().reason(), wire::Refused::VERSION);
  EXPECT_EQ(lastSent().refused().message(), "Please update the client.");
  EXPECT_EQ(counters.malformed_messages, 0u);
}

TEST_F(SessionTest, EndsIfTheFirstMessageIsNotAHello) {
  line.key(1);
  EXPECT_TRUE(ended());
  EXPECT_TRUE(line.sent.empty());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(SessionTest, EndsIfTheMagicIsWrong) {
  line.receive(hello(kProtocolVersion, 1));
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(PlayingSessionTest, MalformedTextLeavesNothingInTheHostsLog) {
  wire::ClientMessage chat_line;
  chat_line.mutable_chat()->set_text("hello");
  std::string bytes = chat_line.SerializeAsString();
  bytes.back() = '\xff';
  testing::internal::CaptureStderr();
  hearBytes(bytes);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
}

TEST_F(PlayingSessionTest, CountsABadFrameAndIsGone) {
  line.callbacks.on_closed(CloseReason::kProtocol);
  EXPECT_EQ(session.state(), Session::State::kGone);
  EXPECT_EQ(counters.malformed_frames, 1u);
  EXPECT_EQ(gone, 1);
  const std::size_t sent = line.sent.size();
  session.sendGoodbye("too late");
  EXPECT_EQ(line.sent.size(), sent);
}

TEST_F(PlayingSessionTest, InputsComeInOrderAtMost16ATick) {
  for (std::uint32_t id = 1; id <= 20; ++id) line.key(id);
  std::vector<std::uint32_t> first16(16);
  std::iota(first16.begin(), first16.end(), 1u);
  EXPECT_EQ(drainInputs(), first16);
  EXPECT_EQ(drainInputs(), (std::vector<std::uint32_t>{17, 18, 19, 20}));
  EXPECT_TRUE(drainInputs().empty());
}

TEST_F(PlayingSessionTest, ARepeatedOrLateInputIsIgnoredAndCounted) {
  for (const std::uint32_t id : {1u, 2u, 2u, 5u, 3u}) line.key(id);
  EXPECT_EQ(drainInputs(), (std::vector<std::uint32_t>{1, 2, 5}));
  line.key(5);
  EXPECT_TRUE(drainInputs().empty());
  line.receive(inputs({keyInput(4), keyInput(5), keyInput(6)}));
  EXPECT_EQ(drainInputs(), std::vector<std::uint32_t>{6});
  EXPECT_EQ(counters.repeated_inputs, 5u);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(PlayingSessionTest, EndsAtMoreInputsThanTheQueueHolds) {
  for (std::uint32_t id = 1; id <= ReceivedInputs::kMaxQueued; ++id) line.key(id);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  line.key(ReceivedInputs::kMaxQueued + 1);
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().goodbye().message(), "Disconnected: too many keys at once.");
  EXPECT_EQ(counters.input_floods, 1u);
}

TEST_F(PlayingSessionTest, PartlyInvalidUpdateIsRejectedEntirely) {
  line.receive(inputs({keyInput(1), keyInput(2, 127)}));
  EXPECT_TRUE(ended());
  EXPECT_TRUE(drainInputs().empty());
}

class BadInput : public PlayingSessionTest, public testing::WithParamInterface<int> {};

TEST_P(BadInput, EndsTheSession) {
  wire::ClientMessage nothing;
  nothing.set_update("");
  const std::string bad[] = {"\xff\xff\xff", "", hello().SerializeAsString(), nothing.SerializeAsString(),
                             inputs({keyInput(1, df::Keyboard::kKeyCount)}).SerializeAsString()};
  hearBytes(bad[GetParam()]);
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.malformed_messages, 1u);
  line.say("still there?");
  EXPECT_TRUE(chat.empty()) << "nothing is heard any more";
  EXPECT_TRUE(drainInputs().empty());
}

INSTANTIATE_TEST_SUITE_P(Session, BadInput, testing::Range(0, 5));

TEST_F(PlayingSessionTest, ChatIsSanitizedAndLimitedToThreeASecond) {
  for (int i = 0; i < 5; ++i) line.say("  line\x1b " + std::to_string(i));
  EXPECT_EQ(chat, (std::vector<std::string>{"line 0", "line 1", "line 2"}));
  EXPECT_EQ(counters.chat_dropped, 2u);
  now += 330ms;
  line.say("too early");
  EXPECT_EQ(chat.size(), 3u);
  now += 10ms;
  line.say("again");
  EXPECT_EQ(chat.back(), "again");
  for (int i = 0; i < 1'000; ++i, now += 10ms) line.say("for ten seconds");
  EXPECT_NEAR(static_cast<double>(chat.size()), 4 + 30, 1);
}

TEST_F(PlayingSessionTest, WorldResetsAreLimitedToOncePerTwoSeconds) {
  ClientUpdate update;
  update.needs_reset = true;
  for (int i = 0; i < 100; ++i) line.update(update);
  EXPECT_EQ(counters.resets, 1u);
  EXPECT_EQ(counters.resets_dropped, 99u);
  now += 2s - 1ms;
  line.update(update);
  EXPECT_EQ(counters.resets, 1u);
  now += 1ms;
  line.update(update);
  EXPECT_EQ(counters.resets, 2u);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(PlayingSessionTest, ExcessChecksumsAreDroppedAndCounted) {
  ClientUpdate update;
  update.checksum = 1;
  for (int i = 0; i < 100; ++i) line.update(update);
  EXPECT_EQ(counters.checksums_dropped, 99u);
  for (int second = 0; second < 5; ++second) {  // the rate of an honest client
    now += Session::Clock::duration(1s);
    line.update(update);
  }
  EXPECT_EQ(counters.checksums_dropped, 99u);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(PlayingSessionTest, MaximumHonestMessageRateIsAccepted) {
  for (int tick = 0; tick < 3'000; ++tick, now += 33ms) {
    for (int i = 0; i < ClientActivity::kMessagesPerTick; ++i) line.update({});
    session.checkDeadlines(now);
  }
  EXPECT_EQ(session.state(), Session::State::kPlaying);
}

TEST_F(PlayingSessionTest, SustainedMessageFloodEndsTheSession) {
  int ticks = 0;
  for (; ticks < 100 && session.state() == Session::State::kPlaying; ++ticks, now += 33ms) {
    for (int i = 0; i < 2 * ClientActivity::kMessagesPerTick; ++i) line.update({});
    session.checkDeadlines(now);
  }
  EXPECT_TRUE(ended());
  EXPECT_NEAR(ticks, 16, 4) << "those at once";
  EXPECT_EQ(lastSent().goodbye().message(), "Disconnected: too many messages at once.");
  EXPECT_EQ(counters.message_floods, 1u);
}

TEST_F(PlayingSessionTest, BlankChatLinesDoNotCountTowardTheLimit) {
  for (int i = 0; i < 5; ++i) line.say(" \t ");
  line.say("word");
  EXPECT_EQ(chat, std::vector<std::string>{"word"});
}

TEST_F(PlayingSessionTest, AnswersPingsAndNotesTheRoundTrip) {
  wire::ClientMessage ping;
  ping.mutable_ping()->set_token(0x123456789abcdef0);
  ping.mutable_ping()->set_rtt_millis(42);
  line.receive(ping);
  EXPECT_EQ(lastSent().pong().token(), 0x123456789abcdef0u);
  EXPECT_EQ(session.rttMillis(), 42u);
  ping.mutable_ping()->set_rtt_millis(0xFFFFFFFF);
  line.receive(ping);
  EXPECT_EQ(session.rttMillis(), 99'999u);
}

TEST_F(PlayingSessionTest, LeaveIsAnsweredAndEndsTheSession) {
  wire::ClientMessage leave;
  leave.mutable_leave();
  line.receive(leave);
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().goodbye().message(), "You left the game.");
  EXPECT_EQ(gone, 1) << "at once";
  line.callbacks.on_closed(CloseReason::kLocal);
  EXPECT_EQ(gone, 1);
}

TEST_F(PlayingSessionTest, TerminalResizesAreAppliedFourTimesASecond) {
  test::PublishedWorld world({}, 7);
  int taken_over = 0;
  for (int i = 0; i < 100; ++i, now += 10ms) {  // the window is resized for a second
    const std::uint64_t deferred = counters.resizes_deferred;
    wire::ClientMessage resize;
    resize.mutable_resize()->set_columns(20 + i);
    line.receive(resize);
    taken_over += counters.resizes_deferred == deferred ? 1 : 0;
    world.tick();
    session.sendTick(world.publisher, world.player());
  }
  EXPECT_NEAR(taken_over, 4, 1);
}

TEST_F(SessionTest, EndsWithoutAHelloInFiveSeconds) {
  listenUntil(session, 5s);
  EXPECT_EQ(session.state(), Session::State::kGreeting);
  listenUntil(session, 5s + 1ms);
  EXPECT_TRUE(ended());
  EXPECT_EQ(lastSent().refused().reason(), wire::Refused::BAD_REQUEST);
  EXPECT_EQ(counters.login_timeouts, 1u);
}

TEST_F(SessionTest, HelloReceivedDuringAServerStallIsAccepted) {
  session.checkDeadlines(now);
  session.checkDeadlines(now + 20s);  // a hello that arrived in the meantime is read next
  EXPECT_EQ(session.state(), Session::State::kGreeting);
  greet();
  session.checkDeadlines(now + 60s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  EXPECT_EQ(counters.login_timeouts + counters.idle_timeouts, 0u);
}

TEST_F(SessionTest, HelloNotEvaluatedInTimeIsRefusedAsBusy) {
  Wire waiting_line;
  Session waiting(std::make_unique<FakeChannel>(waiting_line), counters, now);
  int hellos = 0;
  waiting.start({[&](Session&, const wire::Hello&) { ++hellos; },  // the password is never checked
                 [](Session&, const std::string&) {}, [](Session&) {}, [this] { return now; }});
  waiting_line.receive(hello());
  ASSERT_EQ(hellos, 1);
  listenUntil(waiting, 0s);  // restarts the clock: the hello came before
  listenUntil(waiting, Session::kAdmissionTimeout);
  EXPECT_EQ(waiting.state(), Session::State::kGreeting);
  listenUntil(waiting, Session::kAdmissionTimeout + 1ms);
  EXPECT_TRUE(waiting_line.closed);
  ASSERT_EQ(waiting_line.sent.size(), 1u);
  EXPECT_EQ(waiting_line.sent[0].refused().reason(), wire::Refused::BUSY);
  EXPECT_EQ(counters.login_timeouts, 1u);
}

TEST_F(PlayingSessionTest, EndsAfterFifteenSecondsOfSilence) {
  listenUntil(session, 0s);  // restarts the clock: the hello came before
  listenUntil(session, 15s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  line.say("still here");
  listenUntil(session, 30s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  listenUntil(session, 30s + 1ms);
  EXPECT_TRUE(ended());
  EXPECT_EQ(counters.idle_timeouts, 1u);
  EXPECT_FALSE(lastSent().goodbye().message().empty());
  session.checkDeadlines(now + 99s);
  EXPECT_EQ(counters.idle_timeouts, 1u);
}

TEST_F(PlayingSessionTest, FifteenSilentSecondsDetachAResumableSession) {
  session.setGrace(60s);
  listenUntil(session, 0s);  // restarts the clock
  listenUntil(session, 15s + 1ms);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  EXPECT_TRUE(session.isDetached());
  EXPECT_EQ(counters.idle_timeouts, 1u);
  EXPECT_EQ(gone, 0);
  listenUntil(session, 60s);
  EXPECT_EQ(session.state(), Session::State::kPlaying);
  listenUntil(session, 60s + 1ms);
  EXPECT_EQ(session.state(), Session::State::kGone);
  EXPECT_EQ(counters.reconnect_timeouts, 1u);
  EXPECT_EQ(gone, 1);
}

TEST_F(PlayingSessionTest, SkipsTicksWhileBytesAreUnsentThenCatchesUp) {
  test::PublishedWorld world({}, 5);
  test::SnapshotReader reader;
  std::size_t read = line.sent.size();
  const auto tick = [&](bool quiet = false) {
    world.tick(quiet);
    session.sendTick(world.publisher, world.player());
  };
  const auto receive = [&] {
    for (; read < line.sent.size(); ++read) {
      const wire::ServerMessage& message = line.sent[read];
      ASSERT_EQ(message.payload_case(), wire::ServerMessage::kSnapshot);
      reader.read(message.snapshot());
    }
    ClientUpdate update;
    update.acks = reader.acks;
    line.update(update);
  };

  for (int round = 0; round < 20; ++round) {
    line.unsent = 1;
    const std::size_t before = line.sent.size();
    for (int i = 0; i < 25; ++i) tick();
    ASSERT_EQ(line.sent.size(), before);
    line.unsent = 0;
    for (int i = 0; i < 3; ++i) {  // reused slots take one more round trip
      tick();
      receive();
    }
    tick(true);
    receive();
    const df::Canvas wanted = world.picture(0);
    const df::Canvas seen = reader.replica.render(world.tickNumber());
    ASSERT_EQ(countDifferences(wanted, seen), 0) << "round " << round << "\n" << test::explain(wanted, seen);
  }
  EXPECT_EQ(counters.skipped_ticks, 20u * 25u);
  EXPECT_GT(counters.snapshots, 20u);
}

TEST_F(PlayingSessionTest, SnapshotsNameTheNewestInputThatReachedTheGame) {
  test::PublishedWorld world({}, 6);
  line.key(1);
  line.key(4);
  drainInputs(world.tickNumber() + 1);
  line.key(5);
  world.tick();
  session.sendTick(world.publisher, world.player());
  Snapshot snapshot;
  ASSERT_EQ(Replica(world.tickNumber()).read(lastSent().snapshot(), snapshot), ReadResult::kOk);
  EXPECT_TRUE(snapshot.header.has_input);
  EXPECT_EQ(snapshot.header.input, 4u);
  EXPECT_EQ(snapshot.header.input_tick, world.tickNumber());
}

constexpr std::size_t kPile = StallDetector::kStallThreshold + 1000;

class StallDetectorTest : public testing::Test {
 protected:
  StallDetector detector;
  StallDetector::Time now{1h};
};

TEST_F(StallDetectorTest, SlowStreamIsNotStuck) {
  for (std::size_t left = 900'000; left > 1000; left -= 1000, now += 9s) {
    ASSERT_FALSE(detector.addSample(left, now)) << left;
  }
}

TEST_F(StallDetectorTest, SmallBacklogIsNeverStuck) {
  for (int i = 0; i < 100; ++i, now += 1s)
    ASSERT_FALSE(detector.addSample(StallDetector::kStallThreshold, now));
}

TEST_F(StallDetectorTest, EachNewBacklogRestartsTheTimeout) {
  detector.addSample(kPile, now);
  detector.addSample(10, now + 9s);
  EXPECT_FALSE(detector.addSample(kPile, now + 10s));
  EXPECT_FALSE(detector.addSample(kPile, now + 19s));
  detector.restart();
  EXPECT_FALSE(detector.addSample(kPile, now + 20s)) << "another stream";
  EXPECT_TRUE(detector.addSample(kPile, now + 30s));
}

}  // namespace
}  // namespace naiad
