#include "ClientSessionFixture.h"
#include "client/session/ClientSession.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using State = ClientSession::State;

class ClientSessionTest : public test::ClientSessionFixture {
 protected:
  /// Calls update() ten times a second, like an owner that runs all the time.
  void listenUntil(ClientSession::Time end) {
    for (listened = std::max(listened, now); listened < end; listened += 100ms) session->update(listened);
    session->update(end);
  }

 private:
  ClientSession::Time listened{};
};

/// A client that has been welcomed.
class PlayingClientTest : public ClientSessionTest {
 protected:
  void SetUp() override {
    ClientSessionTest::SetUp();
    join();
  }
};

TEST_F(ClientSessionTest, SaysHelloFirst) {
  ASSERT_EQ(log.sent.size(), 1u);
  ASSERT_TRUE(log.sent[0].has_hello());
  const wire::Hello& hello = log.sent[0].hello();
  EXPECT_EQ(hello.magic(), kHelloMagic);
  EXPECT_EQ(hello.protocol(), kProtocolVersion);
  EXPECT_EQ(hello.player_name(), "Ada");
  EXPECT_EQ(hello.game(), "saucershoot");
  EXPECT_EQ(hello.program(), "test 1");
  EXPECT_EQ(hello.columns(), 100u);
  EXPECT_EQ(hello.rows(), 40u);
  EXPECT_EQ(log.receive_limit, kMaxServerFrame);
  EXPECT_EQ(session->state(), State::kGreeting);
}

TEST_F(PlayingClientTest, PlaysAfterTheWelcome) {
  EXPECT_EQ(session->state(), State::kPlaying);
  EXPECT_EQ(session->welcome().player, 3u);
  EXPECT_EQ(session->welcome().tick, 33333us);
  EXPECT_EQ(session->welcome().help, std::vector<std::string>{"Space fires."});
  EXPECT_TRUE(last().has_ping()) << "the round trip is measured from the start";
}

TEST_F(PlayingClientTest, MissingFirstPictureEndsTheSessionWithAMessage) {
  wire::ServerMessage pong;
  pong.mutable_pong()->set_token(12345);
  const auto welcomed = now;
  const auto end = now + ClientSession::kPictureTimeout;
  for (now += 100ms; now < end; now += 100ms) {
    if ((end - now) % 1s == 0s) receive(pong);  // the server is alive but sends nothing else
    session->update(now);
    ASSERT_EQ(session->state(), State::kPlaying);
    EXPECT_EQ(session->pictureWait(now), now - welcomed);
  }
  now = end;
  session->update(now);
  EXPECT_EQ(session->state(), State::kLost);
  EXPECT_EQ(session->message(), "Joined, but the server sent no picture within 45 s.");
  EXPECT_TRUE(last().has_leave()) << "it keeps no place";
  EXPECT_TRUE(log.closed);
}

TEST_F(PlayingClientTest, FirstPictureDisablesThePictureTimeout) {
  snapshot(1, 10);
  now += EpochReplicas::kIncompleteTimeout;
  EXPECT_EQ(session->pictureWait(now), 0s);
  wire::ServerMessage pong;
  pong.mutable_pong()->set_token(12345);
  for (const auto end = now + 2 * ClientSession::kPictureTimeout; now < end; now += 100ms) {
    receive(pong);
    session->update(now);
  }
  EXPECT_EQ(session->state(), State::kPlaying);
}

TEST_F(ClientSessionTest, RefusalKeepsItsMessage) {
  wire::ServerMessage message;
  message.mutable_refused()->set_reason(wire::Refused::FULL);
  message.mutable_refused()->set_message("The server is full (4 players).");
  receive(message);
  EXPECT_EQ(session->state(), State::kRefused);
  EXPECT_EQ(session->message(), "The server is full (4 players).");
  EXPECT_TRUE(log.closed);
}

TEST_F(PlayingClientTest, GoodbyeKeepsItsSanitizedMessage) {
  wire::ServerMessage message;
  message.mutable_goodbye()->set_message("Maintenance\033[31m at nine.");
  receive(message);
  EXPECT_EQ(session->state(), State::kEnded);
  EXPECT_EQ(session->message(), "Maintenance?[31m at nine.") << "no escape sequence reaches a terminal";
  EXPECT_EQ(session->counters().bad_messages, 0u);
}

TEST_F(PlayingClientTest, AppliesAndAcknowledgesSnapshots) {
  snapshot(1, 100);
  snapshot(2, 101);
  snapshot(4, 103);
  EXPECT_EQ(lastUpdate().acks.newest, 4u);
  EXPECT_EQ(lastUpdate().acks.mask, 0b110u) << "3 is missing";
  EXPECT_EQ(session->replica().aliveCount(), 1u);
  EXPECT_EQ(session->replica().render(103).at(10, 4), (df::Cell{U'@', df::RED}));
  EXPECT_EQ(session->counters().snapshots, 3u);
  EXPECT_TRUE(session->hasPicture(now));
}

TEST_F(PlayingClientTest, AcknowledgesEveryThirdSnapshotOrAfterADelay) {
  const std::size_t before = log.sent.size();
  snapshot(1, 100);
  snapshot(2, 101);
  EXPECT_EQ(log.sent.size(), before);
  snapshot(3, 102);
  ASSERT_EQ(log.sent.size(), before + 1);
  EXPECT_EQ(lastUpdate().acks.newest, 3u);
  EXPECT_EQ(lastUpdate().acks.mask, 0b11u);

  snapshot(4, 103);
  session->update(now + UpdateTiming::kAckDelay - std::chrono::milliseconds(1));
  EXPECT_EQ(log.sent.size(), before + 1);
  EXPECT_EQ(session->nextWake(), now + UpdateTiming::kAckDelay);
  session->update(now + UpdateTiming::kAckDelay);
  ASSERT_EQ(log.sent.size(), before + 2);
  EXPECT_EQ(lastUpdate().acks.newest, 4u);
}

TEST_F(PlayingClientTest, AnInputCarriesTheAcknowledgements) {
  snapshot(1, 100);
  snapshot(2, 101);
  ASSERT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  EXPECT_EQ(lastUpdate().acks.newest, 2u);
  const std::size_t before = log.sent.size();
  session->update(now + UpdateTiming::kAckDelay);
  snapshot(3, 102);
  snapshot(4, 103);
  EXPECT_EQ(log.sent.size(), before) << "two since then";
}

TEST_F(PlayingClientTest, ObserverSeesTheReplicaBeforeTheSnapshot) {
  std::vector<std::pair<std::uint32_t, std::size_t>> seen;
  session->onBeforeSnapshot(
      [&](std::uint32_t tick) { seen.emplace_back(tick, session->replica().aliveCount()); });
  snapshot(1, 100);
  snapshot(2, 101);
  EXPECT_EQ(seen, (std::vector<std::pair<std::uint32_t, std::size_t>>{{100, 0}, {101, 1}}));
}

TEST_F(PlayingClientTest, InputsAreNumberedFromOneWithTheNewestSnapshot) {
  snapshot(7, 100);
  EXPECT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  const Input key = lastInput();
  EXPECT_EQ(key.id, 1u);
  EXPECT_EQ(key.tick, 101u) << "the tick that takes it in";
  EXPECT_EQ(key.snapshot, 7u);
  EXPECT_FALSE(key.is_mouse);
  EXPECT_EQ(key.key, df::Keyboard::SPACE);
  EXPECT_EQ(key.action, df::KEY_PRESSED);
  EXPECT_TRUE(session->sendMouse(df::CLICKED, df::Mouse::RIGHT, 12, 5, now));
  const Input click = lastInput();
  EXPECT_EQ(click.id, 2u);
  EXPECT_TRUE(click.is_mouse);
  EXPECT_EQ(click.button, 2u);
  EXPECT_EQ(click.x, 12);
  EXPECT_EQ(click.y, 5);
}

TEST_F(ClientSessionTest, SixteenBitTicksAreExpandedFromTheWelcome) {
  wire::ServerMessage welcome = welcomeMessage();
  welcome.mutable_welcome()->set_tick(3'000'000'000);
  receive(welcome);
  snapshot(1, 3'000'000'123);
  EXPECT_EQ(session->replica().newest().tick, 3'000'000'123u);
  EXPECT_EQ(session->clock().newestTick(), 3'000'000'123u);
}

// The snapshot names a definition that a newer one has replaced, so it counts as lost.
TEST_F(PlayingClientTest, AStaleSnapshotIsDroppedAndNotAcknowledged) {
  const auto bare = [](std::uint32_t number, std::uint32_t slot, bool sets) {
    SnapshotHeader header;
    header.number = number;
    header.tick = 100;
    return test::bareSnapshot(header, slot, sets);
  };
  receive(bare(1, 0, true));
  receive(bare(3, 0, true));
  const std::size_t sent = log.sent.size();
  receive(bare(2, 1, false));
  EXPECT_EQ(session->state(), State::kPlaying);
  EXPECT_EQ(session->counters().stale_snapshots, 1u);
  EXPECT_EQ(session->counters().snapshots, 2u);
  EXPECT_EQ(log.sent.size(), sent);
  receive(bare(4, 1, false));
  acknowledge();
  EXPECT_EQ(lastUpdate().acks.newest, 4u);
  EXPECT_EQ(lastUpdate().acks.mask, 0b101u);
}

TEST_F(ClientSessionTest, EarlyInputAndInvalidKeysAreNotSent) {
  EXPECT_FALSE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  join();
  EXPECT_FALSE(session->sendKey(df::Keyboard::UNDEFINED_KEY, df::KEY_PRESSED, now));
  EXPECT_FALSE(session->sendKey(static_cast<df::Keyboard::Key>(999), df::KEY_PRESSED, now));
  EXPECT_EQ(session->counters().inputs, 0u);
}

TEST_F(PlayingClientTest, InputRateStaysWithinTheServersLimit) {
  int sent = 0;
  for (int i = 0; i < 1000; ++i)
    sent += session->sendMouse(df::MOVED, df::Mouse::LEFT, i % 80, 1, now) ? 1 : 0;
  EXPECT_LE(sent, 32);
  EXPECT_TRUE(session->sendKey(df::Keyboard::A, df::KEY_RELEASED, now)) << "a release is never lost";
  sent = 0;
  std::uint32_t newest = 0;
  for (std::uint32_t tick = 1; tick <= 300; ++tick) {
    now += 33333us;
    receive(snapshotMessage(tick, tick, newest));
    for (int i = 0; i < 100; ++i)
      sent += session->sendMouse(df::MOVED, df::Mouse::LEFT, i % 80, 1, now) ? 1 : 0;
    newest = lastInput().id;
  }
  EXPECT_LE(sent, 300 * 16);
  EXPECT_GE(sent, 300 * 8);
}

TEST_F(PlayingClientTest, MeasuresTheRoundTrip) {
  const auto answer = [this](std::chrono::milliseconds after) {
    const auto token = last().ping().token();
    now += after;
    wire::ServerMessage message;
    message.mutable_pong()->set_token(token);
    receive(message);
  };
  answer(40ms);
  EXPECT_EQ(session->roundTrip(), 40ms);
  now += 960ms;
  session->update(now);
  ASSERT_TRUE(last().has_ping());
  EXPECT_EQ(last().ping().rtt_millis(), 40u);
  answer(120ms);
  EXPECT_EQ(session->roundTrip(), 50ms) << "smoothed by an eighth";
  wire::ServerMessage made_up;
  made_up.mutable_pong()->set_token(12345);
  receive(made_up);
  EXPECT_EQ(session->roundTrip(), 50ms);
}

TEST_F(PlayingClientTest, SendsOnePingASecond) {
  const std::size_t before = log.sent.size();
  for (int i = 0; i < 50; ++i) session->update(now += 100ms);
  EXPECT_EQ(log.sent.size() - before, 5u);
}

TEST_F(ClientSessionTest, GreetingTimesOutAfterFiveSeconds) {
  listenUntil(now + 4900ms);
  EXPECT_EQ(session->state(), State::kGreeting);
  listenUntil(now + 5s);
  EXPECT_EQ(session->state(), State::kLost);
  EXPECT_FALSE(session->message().empty());
}

TEST_F(ClientSessionTest, TimeoutIgnoresTimeWhileTheProcessWasSuspended) {
  session->update(now);
  session->update(now += 20s);  // the server's answer has arrived and will be read next
  EXPECT_EQ(session->state(), State::kGreeting) << session->message();
  receive(welcomeMessage());
  session->update(now += 60s);
  EXPECT_EQ(session->state(), State::kPlaying) << session->message();
}

TEST_F(PlayingClientTest, SilentGameTimesOutAfterFifteenSeconds) {
  listenUntil(now + 14900ms);
  EXPECT_EQ(session->state(), State::kPlaying);
  listenUntil(now + 15s);
  EXPECT_EQ(session->state(), State::kLost);
}

TEST_F(ClientSessionTest, ResumableSessionWaitsSixtySecondsForTheServer) {
  wire::ServerMessage message = welcomeMessage();
  message.mutable_welcome()->set_resume_token(std::string(16, 't'));
  receive(message);
  snapshot(1, 10);
  listenUntil(now + 15s);
  EXPECT_EQ(session->state(), State::kPlaying);
  EXPECT_TRUE(session->isDetached());
  listenUntil(now + 59s);
  EXPECT_EQ(session->state(), State::kPlaying);
  listenUntil(now + 60s);
  EXPECT_EQ(session->state(), State::kLost);
  EXPECT_FALSE(session->message().empty());
}

TEST_F(PlayingClientTest, ResentWorldContinuesTheNumbering) {
  snapshot(20'000, 10);
  receive(snapshotMessage(40'000, 11, 20'000));
  receive(snapshotMessage(40'001, 12, 40'000));
  SnapshotHeader header;
  header.number = 40'002;
  header.tick = 13;
  header.epoch = 1;
  header.has_input = true;
  header.input = 40'001;
  header.input_tick = 13;
  receive(test::bareSnapshot(header));
  EXPECT_EQ(session->counters().resets, 1u);
  EXPECT_EQ(session->replica().aliveCount(), 0u);
  EXPECT_EQ(session->replica().newest().number, 40'002u);
  EXPECT_EQ(session->replica().newest().input, 40'001u);
  acknowledge();
  EXPECT_EQ(lastUpdate().acks.newest, 40'002u);
}

TEST_F(PlayingClientTest, LostServerCancelsTheDueAcknowledgement) {
  snapshot(1, 100);
  ASSERT_TRUE(session->nextWake());
  session->closed(CloseReason::kPeer);
  EXPECT_EQ(session->state(), State::kLost);
  EXPECT_EQ(session->nextWake(), std::nullopt) << "who waits for it would never do anything else";
}

TEST_F(PlayingClientTest, LeavingSendsALeaveMessage) {
  session->leave();
  EXPECT_TRUE(last().has_leave());
  EXPECT_TRUE(log.closed);
  EXPECT_EQ(session->state(), State::kLeft);
  session->closed(CloseReason::kLocal);
  EXPECT_EQ(session->state(), State::kLeft);
}

TEST_F(PlayingClientTest, MissingSnapshotsCountAsSilenceAfterHalfASecond) {
  EXPECT_FALSE(session->isSilent(now + 1h)) << "before the first snapshot there is nothing to miss";
  snapshot(1, 100);
  EXPECT_FALSE(session->isSilent(now + 499ms));
  EXPECT_TRUE(session->isSilent(now + 500ms));
  now += 600ms;
  snapshot(2, 118);
  EXPECT_FALSE(session->isSilent(now));
}

TEST_F(PlayingClientTest, PendingInputsAreLimitedWhileTheServerStalls) {
  snapshot(1, 100);
  for (int tick = 0; tick < 300; ++tick) {
    session->sendKey(df::Keyboard::SPACE, df::KEY_DOWN, now);
    now += 33ms;
  }
  EXPECT_EQ(session->counters().inputs, InputOutbox::kMax) << "a server lets no more than 64 wait";
  EXPECT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_RELEASED, now)) << "or it would stay down";
  const std::uint32_t newest = lastInput().id;
  EXPECT_FALSE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  receive(snapshotMessage(2, 101, newest));
  EXPECT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  receive(snapshotMessage(3, 102, newest + 20));  // this input was never sent
  EXPECT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
  EXPECT_EQ(lastInput().id, newest + 2);
}

TEST_F(PlayingClientTest, SoundsAreDeliveredOnce) {
  wire::ServerMessage message;
  wire::Sound& sound = *message.mutable_sounds()->add_sounds();
  sound.set_label("\x1b[2Jfire");
  sound.set_player(3);
  message.set_number(1);
  receive(message);
  receive(message);  // a retransmission
  const auto heard = session->popSounds();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0], (SoundLine{"?[2Jfire", SoundLine::Action::kPlay, false, false, 3}));
  EXPECT_TRUE(session->popSounds().empty());
  EXPECT_EQ(session->counters().repeated_frames, 1u);
  message.clear_number();
  for (int i = 0; i < 100; ++i) receive(message);
  EXPECT_EQ(session->popSounds().size(), ReliableInbox::kMaxSounds);
  EXPECT_EQ(session->counters().sounds, 101u);
}

}  // namespace
}  // namespace naiad
