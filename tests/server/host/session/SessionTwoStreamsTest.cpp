// A session with two streams: the messages of each stream, and the end of one of them.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "SessionReturn.h"
#include "tests/server/host/snapshot/SimulatedWorld.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

using test::SessionReturn;

class SessionWithTwoStreams : public SessionReturn {
 protected:
  SessionWithTwoStreams() : other(make(second)) { greet(second, "token", false, 0, true); }
  void tick(bool quiet = false) {
    world.tick(quiet);
    publisher.update(world.view());
    session->sendTick(publisher, world.view().players[0]);
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
    sendUpdate(line, update);
  }
  static std::vector<std::string> snapshots(const Wire& line) {
    std::vector<std::string> all;
    for (const wire::ServerMessage& message : line.sent) {
      if (message.has_snapshot()) all.push_back(message.snapshot());
    }
    return all;
  }

  std::unique_ptr<Session> other;
  AckWindow acks;
  test::SimulatedWorld world{{.view_width = 100, .view_height = 40, .objects = 600}, 5};
  Publisher publisher;
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
    key(second, 1, df::Keyboard::SPACE, df::KEY_PRESSED);
    session->checkDeadlines(now);
  }
  EXPECT_TRUE(session->isDetached());
  EXPECT_EQ(counters.idle_timeouts, 1u);
}

TEST_F(SessionWithTwoStreams, DuplicateInputsOfBothStreamsAreTakenOnce) {
  key(second, 1, df::Keyboard::SPACE, df::KEY_PRESSED);
  key(first, 1, df::Keyboard::SPACE, df::KEY_PRESSED);
  key(first, 2, df::Keyboard::SPACE, df::KEY_RELEASED);
  key(second, 2, df::Keyboard::SPACE, df::KEY_RELEASED);
  const std::string space = std::to_string(static_cast<int>(df::Keyboard::SPACE));
  EXPECT_EQ(taken(), (std::vector<std::string>{space + " down", space + " up"}));
  EXPECT_EQ(counters.repeated_inputs, 2u);
}

TEST_F(SessionWithTwoStreams, ChatOnTheSecondStreamEndsTheSession) {
  chatLine(second, "hello", 1);
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
  const auto newer = make(third);
  greet(third, "token", false, 0, true);
  EXPECT_TRUE(second.destroyed);
  settle();
  tick();
  EXPECT_EQ(snapshots(third).size(), 1u);
  session.reset();
  EXPECT_TRUE(third.destroyed) << "before the line that it writes to";
}

}  // namespace
}  // namespace naiad
