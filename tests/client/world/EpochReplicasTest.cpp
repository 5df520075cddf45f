#include <gtest/gtest.h>

#include <chrono>

#include "client/world/EpochReplicas.h"
#include "tests/support/WriteSnapshot.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class EpochReplicasTest : public testing::Test {
 protected:
  /// Feeds snapshot `number`. If `born`, the object with that id is born in it.
  void birth(std::uint32_t number, bool complete, std::uint8_t epoch = 0, bool born = true) {
    const EpochReplicas::Result became = of(epoch, number, complete, born);
    EXPECT_TRUE(became == EpochReplicas::Result::kApplied || became == EpochReplicas::Result::kShown);
  }
  /// Feeds a snapshot without records, which a server sends to find out whether datagrams pass.
  void probe(std::uint32_t number, bool complete) { birth(number, complete, 0, false); }
  std::size_t shown() const { return feed.shown().aliveCount(); }
  bool hasPicture() const { return feed.hasPicture(now); }

  /// Feeds a snapshot of another epoch and returns the result.
  EpochReplicas::Result of(std::uint8_t epoch, std::uint32_t number, bool complete, bool born = true) {
    SnapshotHeader header;
    header.number = number;
    header.tick = tick;
    header.epoch = epoch;
    header.complete = complete;
    ObjectRecord object{number % 1000, 1, kAllGroups, {}};
    object.state.motion.tick = tick;
    object.state.look.sequence = {{Glyph{0, 0, U'@', df::RED}}};
    Records records;
    if (born) records.objects = {object};
    return feed.applySnapshot(test::writeSnapshot(header, records), now, header, nullptr);
  }

  std::uint32_t tick = 100;
  EpochReplicas feed;
  EpochReplicas::Time now = EpochReplicas::Time{} + 1h;
};

// The expected world is farther behind than the 16 bits of a snapshot's tick can express.
TEST_F(EpochReplicasTest, ExpectedWorldMayBeManyTicksBehind) {
  tick = 500'000;
  feed.advanceTick(tick);
  birth(1, true);
  feed.expectWorld(1, 300'000, now);
  tick = 300'010;
  EXPECT_EQ(of(1, 2, true), EpochReplicas::Result::kShown);
  EXPECT_EQ(feed.shown().newest().tick, 300'010u);
  EXPECT_EQ(of(0, 1, true), EpochReplicas::Result::kIgnored);
}

TEST_F(EpochReplicasTest, AnExpectedWorldThatHasBegunAlreadyIsKept) {
  birth(1, true);
  EXPECT_EQ(of(1, 2, false), EpochReplicas::Result::kApplied);
  feed.expectWorld(1, 100, now);
  EXPECT_EQ(of(1, 3, true), EpochReplicas::Result::kShown);
  EXPECT_EQ(shown(), 2u);
  feed.expectWorld(1, 100, now);
  EXPECT_FALSE(feed.isChanging()) << "it is there";
}

TEST_F(EpochReplicasTest, TheFirstPictureWaitsForTheCompleteWorld) {
  EXPECT_FALSE(hasPicture());
  birth(1, false);
  birth(2, false);
  EXPECT_FALSE(hasPicture());
  birth(3, true);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 3u);
  birth(4, false);
  birth(6, false);
  EXPECT_TRUE(hasPicture()) << "what is born later is another matter";
}

TEST_F(EpochReplicasTest, CompleteSnapshotWaitsForEarlierSnapshots) {
  probe(4, true);
  EXPECT_FALSE(hasPicture()) << "it came as a datagram; the world is on the stream";
  birth(1, false);
  birth(2, false);
  probe(5, true);
  EXPECT_FALSE(hasPicture());
  birth(3, true);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 3u);
}

TEST_F(EpochReplicasTest, AnIncompleteWorldIsShownAfterAWhile) {
  now += 10min;
  EXPECT_FALSE(hasPicture()) << "nothing has come";
  birth(1, false);
  now += EpochReplicas::kIncompleteTimeout - 1ms;
  birth(2, false);
  EXPECT_FALSE(hasPicture());
  now += 1ms;
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 2u);
}

TEST_F(EpochReplicasTest, MissingSnapshotIsWaitedForUntilTheTimeout) {
  birth(1, false);
  birth(3, true);
  now += EpochReplicas::kIncompleteTimeout - 1ms;
  EXPECT_FALSE(hasPicture());
  now += 1ms;
  EXPECT_TRUE(hasPicture());
}

TEST_F(EpochReplicasTest, WorldMayNeedMoreSnapshotsThanTheWindow) {
  for (std::uint32_t number = 1; number < 200; ++number) birth(number, false);
  EXPECT_FALSE(hasPicture());
  birth(200, true);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 200u);
}

TEST_F(EpochReplicasTest, ResumedSessionContinuesTheSnapshotNumbers) {
  feed = EpochReplicas({70'000, 100, 0}, 0);
  birth(70'001, false);
  EXPECT_FALSE(hasPicture());
  birth(70'002, true);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 2u);
}

TEST_F(EpochReplicasTest, ResentWorldMayBeTheFirstPicture) {
  birth(1, false);
  birth(2, false, 1);
  EXPECT_FALSE(hasPicture());
  birth(3, true, 1);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 2u);
  EXPECT_EQ(feed.resets(), 1u);
}

TEST_F(EpochReplicasTest, ResentWorldIsShownWhenComplete) {
  birth(1, true);
  birth(2, false, 1);
  EXPECT_TRUE(hasPicture());
  EXPECT_EQ(shown(), 1u) << "the old one";
  EXPECT_TRUE(feed.isChanging());
  birth(3, false, 1);
  birth(4, true, 1);
  EXPECT_EQ(shown(), 3u);
  EXPECT_FALSE(feed.isChanging());
}

TEST_F(EpochReplicasTest, WorldsMayBeSkippedAndEarlierOnesAreIgnored) {
  using Result = EpochReplicas::Result;
  birth(1, true);
  EXPECT_EQ(of(3, 5, true), Result::kShown);
  EXPECT_EQ(of(2, 8, true), Result::kShown) << "two worlds were skipped";
  for (const auto& [epoch, number] : {std::pair{0, 2}, {0, 4}, {3, 6}, {3, 7}, {1, 3}})
    EXPECT_EQ(of(static_cast<std::uint8_t>(epoch), static_cast<std::uint32_t>(number), true),
              Result::kIgnored);
  EXPECT_EQ(feed.resets(), 2u);
  EXPECT_EQ(of(2, 9, true), Result::kApplied);
  EXPECT_EQ(shown(), 2u);
}

TEST_F(EpochReplicasTest, OnlyANewerWorldReplacesAPendingOne) {
  using Result = EpochReplicas::Result;
  birth(1, true);
  EXPECT_EQ(of(1, 2, false), Result::kApplied);
  EXPECT_EQ(of(2, 5, false), Result::kApplied);
  EXPECT_EQ(of(1, 4, true), Result::kIgnored) << "late, on another path";
  EXPECT_EQ(of(0, 3, true), Result::kApplied) << "to the one that is shown still";
  EXPECT_EQ(of(2, 6, true), Result::kShown);
  EXPECT_EQ(shown(), 2u) << "of 5 and 6";
  EXPECT_EQ(feed.resets(), 2u);
}

}  // namespace
}  // namespace naiad
