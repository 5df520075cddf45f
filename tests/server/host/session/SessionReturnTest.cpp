// Streams of a session: it resumes on another one or in another client process, and may have a second one.
#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "host/session/Session.h"
#include "tests/server/host/rooms/Clients.h"
#include "tests/server/host/snapshot/SimulatedWorld.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

/// A session that is welcomed on its first stream, and further sessions for its player.
class SessionReturn : public testing::Test {
 protected:
  using Wire = test::Client;

  SessionReturn() : session(make(first)) {
    session->setGrace(60s);
    first.greet(test::helloOf("Ann"));
  }

  std::unique_ptr<Session> make(Wire& line) {
    auto made = std::make_unique<Session>(std::make_unique<test::FakeChannel>(line), counters, now);
    made->start({[this](Session& s, const wire::Hello& hello) {
                   if (!hello.resume_token().empty()) return onReturn(s, hello);
                   wire::Welcome welcome;
                   welcome.set_player(7);
                   welcome.set_name("Ann");
                   welcome.set_resume_token("secret");
                   s.welcome(welcome);
                 },
                 [this](Session&, const std::string& text) { chat.push_back(text); },
                 [this](Session&) { ++gone; }, [this] { return now; }});
    return made;
  }
  void onReturn(Session& other, const wire::Hello& hello) {
    wire::Welcome welcome = session->welcomed();
    welcome.set_resumed(true);
    if (hello.second_stream()) {
      session->attachSecondStream(other);
    } else if (hello.new_process()) {
      session->restart(other, welcome, nullptr);
    } else {
      session->resumeOn(other, welcome, hello.last_frame());
    }
  }
  /// Makes a session whose client wants to resume that of the player. `received`: its newest reliable frame.
  std::unique_ptr<Session> resume(Wire& line, bool new_process = false, std::uint32_t received = 0,
                                  bool second_stream = false) {
    auto made = make(line);
    wire::Hello hello = test::helloOf("Ann");
    hello.set_second_stream(second_stream);
    hello.set_resume_token("token");
    hello.set_new_process(new_process);
    hello.set_last_frame(received);
    line.greet(hello);
    return made;
  }
  void sendChat(const std::string& text) {
    wire::ServerMessage message;
    message.mutable_chat()->set_text(text);
    session->sendReliable(message);
  }
  static std::vector<std::string> chatOf(const Wire& line) {
    std::vector<std::string> texts;
    for (const wire::ServerMessage& message : line.sent) {
      if (message.has_chat()) texts.push_back(message.chat().text());
    }
    return texts;
  }
  /// Takes the inputs that are due and returns them as "key action", in order.
  std::vector<std::string> taken() {
    std::vector<std::string> inputs;
    session->drainInputs(1, [&](const Input& input) {
      inputs.push_back(std::to_string(input.key) + (input.action == df::KEY_RELEASED ? " up" : " down"));
    });
    return inputs;
  }
  void breakStream(Wire& line) { line.callbacks.on_closed(CloseReason::kError); }

  Session::Clock::time_point now{1000s};
  Counters counters;
  std::vector<std::string> chat;
  int gone = 0;
  Wire first;
  Wire second;
  std::deque<Wire> lines;  ///< further streams
  std::unique_ptr<Session> session;
};

TEST_F(SessionReturn, UnacknowledgedMessagesAreSentAgainOnTheNextStream) {
  for (const char* text : {"a", "b", "c"}) sendChat(text);
  EXPECT_EQ(chatOf(first), (std::vector<std::string>{"a", "b", "c"}));
  first.ping(1);
  breakStream(first);
  sendChat("d");
  const auto other = resume(second, false, 2);
  EXPECT_EQ(chatOf(second), (std::vector<std::string>{"c", "d"}))
      << "b had arrived; its acknowledgement came with the hello";
  EXPECT_EQ(second.sent[0].payload_case(), wire::ServerMessage::kWelcome) << "the answer first";
  EXPECT_EQ(second.sent[1].number(), 3u);
}

TEST_F(SessionReturn, BestEffortMessagesAreSentNowOrDropped) {
  wire::ServerMessage sound;
  sound.mutable_sounds()->add_sounds()->set_label("fire");
  EXPECT_TRUE(session->sendBestEffort(sound));
  EXPECT_TRUE(first.sent.back().has_sounds());
  EXPECT_EQ(first.sent.back().number(), 0u) << "not kept";
  first.unsent = Session::kMaxUnsentForBestEffort + 1;
  EXPECT_FALSE(session->sendBestEffort(sound));
  breakStream(first);
  EXPECT_FALSE(session->sendBestEffort(sound));
  const auto other = resume(second);
  EXPECT_EQ(second.sent.size(), 1u) << "the welcome";
}

TEST_F(SessionReturn, DuplicateFramesAreIgnored) {
  first.say("one", 1);
  first.say("two", 2);
  breakStream(first);
  const auto other = resume(second);
  EXPECT_EQ(second.sent[0].welcome().last_frame(), 2u);
  second.say("two", 2);
  second.say("three", 3);
  EXPECT_EQ(chat, (std::vector<std::string>{"one", "two", "three"}));
  EXPECT_EQ(counters.repeated_frames, 1u);
  second.ping(0);
  EXPECT_EQ(second.sent.back().pong().last_frame(), 3u);
}

TEST_F(SessionReturn, ChatQueuedWhileDisconnectedMayArriveAtOnce) {
  breakStream(first);
  now += 20s;
  session->checkDeadlines(now);
  const auto other = resume(second);
  for (std::uint32_t i = 1; i <= 20; ++i) second.say("line " + std::to_string(i), i);
  EXPECT_EQ(chat.size(), 20u);
  EXPECT_EQ(counters.chat_dropped, 0u);
  for (std::uint32_t i = 21; i <= 100; ++i) second.say("line " + std::to_string(i), i);
  EXPECT_EQ(chat.size(), 30u);
  EXPECT_EQ(counters.chat_dropped, 70u);
}

TEST_F(SessionReturn, OnlyTimeRefillsTheChatAllowance) {
  std::vector<std::unique_ptr<Session>> others;
  std::uint32_t number = 0;
  Wire* p_line = &first;
  for (int i = 0; i < 25; ++i, now += 200ms) {  // reconnects five times a second, for 5 s
    for (int k = 0; k < 40; ++k) p_line->say("line", ++number);
    breakStream(*p_line);
    p_line = &lines.emplace_back();
    others.push_back(resume(*p_line));
    session->checkDeadlines(now);
  }
  EXPECT_LE(chat.size(), 3u + 5 * 3);
  EXPECT_GE(chat.size(), 5u * 3);
  EXPECT_EQ(counters.chat_dropped + chat.size(), 25u * 40);
  EXPECT_EQ(session->state(), Session::State::kPlaying);
}

/// Only a little chat may wait in the stream of a slow connection, so that snapshots get through.
TEST_F(SessionReturn, ChatNeitherClogsASlowStreamNorBlocksPictures) {
  constexpr std::size_t kPerTick = 300;  // bytes: 72 kbit/s
  test::PublishedWorld world({}, 7);
  std::size_t most = 0;
  std::uint64_t pictures = 0;
  first.on_send = [&, keep = first.on_send](std::string_view frame) {
    keep(frame);
    first.unsent += frame.size();
    pictures += first.sent.back().payload_case() == wire::ServerMessage::kSnapshot ? 1 : 0;
  };
  for (int tick = 0; tick < 1'800; ++tick, now += 33ms) {
    for (int i = 0; i < 6; ++i) sendChat(std::string(200, 'x'));  // chat of 64 players at their limit
    first.unsent -= std::min(first.unsent, kPerTick);
    if (tick % 30 == 0) first.ping(first.sent.back().number());
    session->checkDeadlines(now);
    world.tick();
    session->sendTick(world.publisher, world.player());
    if (pictures > 3) most = std::max(most, first.unsent);  // after the whole world was sent
  }
  EXPECT_EQ(session->state(), Session::State::kPlaying);
  EXPECT_LT(most, 16'000u);
  EXPECT_GT(pictures, 60u) << "one a second";
  EXPECT_GT(chatOf(first).size(), 500u);
  EXPECT_EQ(counters.stalled_streams, 0u);
}

TEST_F(SessionReturn, ResumesAreLimitedToOneASecond) {
  int admitted = 0;
  for (int i = 0; i < 1'000; ++i, now += 10ms) admitted += session->admitResume() ? 1 : 0;
  EXPECT_GE(admitted, 3 + 9);
  EXPECT_LE(admitted, 3 + 10);
  EXPECT_EQ(counters.resumes_deferred + static_cast<std::uint64_t>(admitted), 1'000u);
  for (int i = 0; i < 1'000; ++i, now += 2s) ASSERT_TRUE(session->admitResume()) << i;
  EXPECT_EQ(session->state(), Session::State::kPlaying);
}

TEST_F(SessionReturn, DeferredResumeExtendsTheGracePeriod) {
  breakStream(first);
  for (int i = 0; i < 3; ++i) session->admitResume();
  for (int i = 0; i < 100; ++i, now += 500ms) session->checkDeadlines(now);
  for (int i = 0; i < 4; ++i) session->admitResume();  // one more than allowed
  for (int i = 0; i < 100; ++i, now += 500ms) session->checkDeadlines(now);
  EXPECT_EQ(counters.resumes_deferred, 1u);
  EXPECT_EQ(session->state(), Session::State::kPlaying) << "100 s after the stream broke";
  for (int i = 0; i < 30; ++i, now += 500ms) session->checkDeadlines(now);
  EXPECT_EQ(session->state(), Session::State::kGone);
}

TEST_F(SessionReturn, ResumeInAnotherProcessCountsAsAReset) {
  ClientUpdate update;
  update.needs_reset = true;
  now += 10s;
  const auto other = resume(second, true);
  second.update(update);
  EXPECT_EQ(counters.resets, 0u);
  EXPECT_EQ(counters.resets_dropped, 1u);
  now += 2s;
  second.update(update);
  EXPECT_EQ(counters.resets, 1u);
  Wire& third = lines.emplace_back();
  const auto again = resume(third);  // the same process on another stream
  third.update(update);
  EXPECT_EQ(counters.resets, 1u) << "two seconds, whatever becomes of the stream";
}

TEST_F(SessionReturn, ClientThatSendsButNeverReadsIsDisconnected) {
  first.unsent = 100'000;
  for (int i = 0; i < 101; ++i, now += 100ms, ++first.unsent) {
    first.ping(0);
    session->checkDeadlines(now);
    if (i == 98) {
      EXPECT_EQ(session->state(), Session::State::kPlaying);
    }
  }
  EXPECT_EQ(session->state(), Session::State::kEnding);
  EXPECT_EQ(counters.stalled_streams, 1u);
  EXPECT_EQ(first.sent.back().goodbye().message(), "Disconnected: your connection is too slow.");
}

TEST_F(SessionReturn, SilentClientWithAStuckStreamMayResume) {
  first.unsent = 100'000;
  for (int i = 0; i < 160; ++i, now += 100ms) session->checkDeadlines(now);
  EXPECT_TRUE(session->isDetached());
  EXPECT_EQ(counters.stalled_streams, 0u);
  EXPECT_EQ(counters.detached, 1u);
}

TEST_F(SessionReturn, ResumeInAnotherProcessTellsWhereToContinue) {
  first.key(1, df::Keyboard::A, df::KEY_PRESSED);
  first.key(2, df::Keyboard::A, df::KEY_RELEASED);
  sendChat("old");
  first.say("mine", 5);
  breakStream(first);
  const auto other = resume(second, true);
  EXPECT_EQ(other->state(), Session::State::kGone);
  ASSERT_EQ(second.sent.size(), 1u) << "no old chat";
  const wire::Welcome& welcome = second.sent[0].welcome();
  EXPECT_TRUE(welcome.resumed());
  EXPECT_EQ(welcome.player(), 7u);
  EXPECT_EQ(welcome.name(), "Ann");
  EXPECT_EQ(welcome.resume_state().input(), 2u);
  EXPECT_EQ(welcome.resume_state().world_epoch(), 1u);
  EXPECT_EQ(welcome.last_frame(), 0u);
  second.say("a new process counts from 1", 1);
  EXPECT_EQ(chat.size(), 2u);
  sendChat("new");
  EXPECT_EQ(chatOf(second), std::vector<std::string>{"new"});
  EXPECT_EQ(counters.restarted, 1u);
  EXPECT_EQ(counters.resumed, 1u);
  EXPECT_EQ(gone, 0);
}

TEST_F(SessionReturn, ReplacedProcessGetsAGoodbye) {
  const auto other = resume(second, true);
  EXPECT_EQ(first.sent.back().goodbye().message(), "This session was resumed in another client.");
  EXPECT_TRUE(first.closed);
  EXPECT_FALSE(first.destroyed) << "the message is on its way";
  first.say("still here", 1);
  EXPECT_TRUE(chat.empty());
  second.say("here", 1);
  EXPECT_EQ(chat, std::vector<std::string>{"here"});
  first.callbacks.on_closed(CloseReason::kPeer);
  EXPECT_EQ(other->state(), Session::State::kGone);
  EXPECT_EQ(session->state(), Session::State::kPlaying);
  EXPECT_EQ(gone, 0) << "no player left";
}

TEST_F(SessionReturn, SessionDoesNotKeepItsResumeToken) {
  EXPECT_EQ(first.sent[0].welcome().resume_token(), "secret");
  EXPECT_TRUE(session->welcomed().resume_token().empty());
}

TEST_F(SessionReturn, DisconnectReleasesHeldKeysAfterQueuedInputs) {
  first.key(1, df::Keyboard::B, df::KEY_PRESSED);
  first.key(2, df::Keyboard::A, df::KEY_DOWN);
  first.key(3, df::Keyboard::C, df::KEY_PRESSED);
  first.key(4, df::Keyboard::C, df::KEY_RELEASED);
  const std::string a = std::to_string(int{df::Keyboard::A});
  const std::string b = std::to_string(int{df::Keyboard::B});
  breakStream(first);  // no datagrams either, so the client is gone
  const auto inputs = taken();
  ASSERT_EQ(inputs.size(), 6u);
  EXPECT_EQ(inputs[4], a + " up");
  EXPECT_EQ(inputs[5], b + " up");
  for (int i = 0; i < 50; ++i, now += 100ms) session->checkDeadlines(now);
  EXPECT_TRUE(taken().empty()) << "once";
}

TEST_F(SessionReturn, ResumeOnANewStreamKeepsHeldKeys) {
  first.key(1, df::Keyboard::A, df::KEY_PRESSED);
  const auto other = resume(second);
  EXPECT_EQ(taken().size(), 1u);
  for (int i = 0; i < 50; ++i, now += 100ms) session->checkDeadlines(now);
  EXPECT_TRUE(taken().empty());
}

class SessionWithTwoStreams : public SessionReturn {
 protected:
  void tick(bool quiet = false) {
    world.tick(quiet);
    session->sendTick(world.publisher, world.player());
  }
  /// Sends the world, so that only later changes are pending.
  void settle() {
    tick();
    acknowledge(first);
    forget();
  }
  void forget() {
    first.sent.clear();
    second.sent.clear();
  }
  void acknowledge(Wire& line) {
    for (std::uint32_t n = acks.newest + 1; n <= session->sender().newestNumber(); ++n) acks.addReceived(n);
    ClientUpdate update;
    update.acks = acks;
    line.update(update);
  }
  static std::vector<std::string> snapshots(const Wire& line) {
    std::vector<std::string> all;
    for (const wire::ServerMessage& message : line.sent) {
      if (message.has_snapshot()) all.push_back(message.snapshot());
    }
    return all;
  }

  std::unique_ptr<Session> other = resume(second, false, 0, true);
  AckWindow acks;
  test::PublishedWorld world{{.view_width = 100, .view_height = 40, .objects = 600}, 5};
};

TEST_F(SessionWithTwoStreams, SecondStreamIsWelcomedWithoutANewPlayer) {
  ASSERT_EQ(second.sent.size(), 1u);
  EXPECT_TRUE(second.sent[0].welcome().second_stream());
  EXPECT_EQ(second.sent[0].welcome().resume_token(), "") << "the one that was shown stays good";
  EXPECT_EQ(other->state(), Session::State::kGone);
  EXPECT_TRUE(session->hasSecondStream());
  EXPECT_EQ(counters.second_streams, 1u);
  EXPECT_EQ(counters.resumed, 0u);
  EXPECT_EQ(gone, 0);
  other.reset();
  EXPECT_FALSE(second.destroyed) << "it belongs to the session now";
}

TEST_F(SessionWithTwoStreams, SmallSnapshotsUseBothStreamsLargeOnesTheFirst) {
  tick();
  ASSERT_EQ(snapshots(first).size(), 1u);
  ASSERT_GT(snapshots(first)[0].size(), SnapshotDelivery::kMaxOnSecond) << "all of a world";
  EXPECT_TRUE(snapshots(second).empty());
  acknowledge(first);
  forget();
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_EQ(snapshots(first).size(), 5u);
  EXPECT_EQ(snapshots(second), snapshots(first));
}

TEST_F(SessionWithTwoStreams, SecondStreamDoesNotOvertakeALargeSnapshot) {
  tick();
  forget();
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_EQ(snapshots(first).size(), 5u);
  EXPECT_TRUE(snapshots(second).empty());
  first.unsent = 1;
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_EQ(snapshots(first).size(), 5u);
  EXPECT_TRUE(snapshots(second).empty());
  first.unsent = 0;
  acknowledge(first);
  forget();
  tick();
  EXPECT_EQ(snapshots(second).size(), 1u);
}

TEST_F(SessionWithTwoStreams, BlockedStreamDoesNotBlockTheOther) {
  settle();
  first.unsent = 100;
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_TRUE(snapshots(first).empty());
  EXPECT_EQ(snapshots(second).size(), 5u);
  forget();
  first.unsent = 0;
  second.unsent = 100;
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_EQ(snapshots(first).size(), 5u);
  EXPECT_TRUE(snapshots(second).empty());
  forget();
  first.unsent = 100;
  const std::uint64_t skipped = session->skippedTicks();
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_TRUE(snapshots(first).empty() && snapshots(second).empty());
  EXPECT_EQ(session->skippedTicks() - skipped, 5u);
}

TEST_F(SessionWithTwoStreams, PendingChatDoesNotBlockTheSecondStream) {
  settle();
  sendChat(std::string(200, 'x'));
  first.unsent = 10'000;
  for (int i = 0; i < 5; ++i) tick();
  EXPECT_EQ(snapshots(second).size(), 5u);
}

TEST_F(SessionWithTwoStreams, DeadFirstStreamDetachesTheSession) {
  for (int i = 0; i < 200; ++i, now += 100ms) {
    second.key(1, df::Keyboard::SPACE, df::KEY_PRESSED);
    session->checkDeadlines(now);
  }
  EXPECT_TRUE(session->isDetached());
  EXPECT_EQ(counters.idle_timeouts, 1u);
}

TEST_F(SessionWithTwoStreams, DuplicateInputsOfBothStreamsAreTakenOnce) {
  second.key(1, df::Keyboard::SPACE, df::KEY_PRESSED);
  first.key(1, df::Keyboard::SPACE, df::KEY_PRESSED);
  first.key(2, df::Keyboard::SPACE, df::KEY_RELEASED);
  second.key(2, df::Keyboard::SPACE, df::KEY_RELEASED);
  const std::string space = std::to_string(static_cast<int>(df::Keyboard::SPACE));
  EXPECT_EQ(taken(), (std::vector<std::string>{space + " down", space + " up"}));
  EXPECT_EQ(counters.repeated_inputs, 2u);
}

TEST_F(SessionWithTwoStreams, ChatOnTheSecondStreamEndsTheSession) {
  second.say("hello", 1);
  EXPECT_TRUE(chat.empty());
  EXPECT_EQ(counters.malformed_messages, 1u);
  EXPECT_EQ(session->state(), Session::State::kEnding);
  EXPECT_TRUE(second.destroyed);
}

TEST_F(SessionWithTwoStreams, MalformedFrameOnTheSecondStreamEndsTheSession) {
  second.callbacks.on_frame("\xff\xff");
  EXPECT_EQ(counters.malformed_messages, 1u);
  EXPECT_EQ(session->state(), Session::State::kEnding);
}

TEST_F(SessionWithTwoStreams, LossOfTheSecondStreamKeepsTheSession) {
  settle();
  second.callbacks.on_closed(CloseReason::kError);
  EXPECT_FALSE(session->hasSecondStream());
  EXPECT_EQ(session->state(), Session::State::kPlaying);
  EXPECT_EQ(counters.detached, 0u);
  tick();
  EXPECT_EQ(snapshots(first).size(), 1u);
}

TEST_F(SessionWithTwoStreams, TheSecondEndsWithTheFirst) {
  breakStream(first);
  EXPECT_TRUE(session->isDetached());
  EXPECT_FALSE(session->hasSecondStream());
  EXPECT_TRUE(second.destroyed);
}

TEST_F(SessionWithTwoStreams, NewSecondStreamReplacesTheOldOne) {
  Wire& third = lines.emplace_back();
  const auto newer = resume(third, false, 0, true);
  EXPECT_TRUE(second.destroyed);
  settle();
  tick();
  EXPECT_EQ(snapshots(third).size(), 1u);
  session.reset();
  EXPECT_TRUE(third.destroyed) << "before the line that it writes to";
}

}  // namespace
}  // namespace naiad
