// When copies of a world are due, and their positions in the round.
#include <gtest/gtest.h>

#include "host/journal/RoundHistory.h"

namespace naiad {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t kRecord = 10;  ///< bytes per tick

/// Plays a tick of length `time`, with a copy if one is due. Returns whether one was due.
bool play(RoundHistory& round, std::uint32_t tick, milliseconds time = milliseconds(0)) {
  const bool due = round.isCheckpointDue(tick, [&] { return tick * time; });
  if (due) round.beginCheckpoint(tick, {tick}, true);
  EXPECT_TRUE(round.add(std::string(kRecord, 'x')));
  EXPECT_EQ(round.endTick(), due);
  return due;
}

/// Plays this many ticks of length `time`. Returns those in which a copy was due.
std::vector<std::uint32_t> dueIn(std::uint32_t ticks, milliseconds time) {
  RoundHistory round;
  std::vector<std::uint32_t> due;
  for (std::uint32_t tick = 1; tick <= ticks; ++tick) {
    if (play(round, tick, time)) due.push_back(tick);
  }
  return due;
}

TEST(RoundHistory, SlowTicksShortenTheCheckpointInterval) {
  EXPECT_EQ(dueIn(700, milliseconds(0)), (std::vector<std::uint32_t>{30, 330, 630}));
  EXPECT_EQ(dueIn(300, milliseconds(1)), (std::vector<std::uint32_t>{30, 150, 270}));
}

TEST(RoundHistory, TakingACheckpointKeepsEarlierAndDropsLaterOnes) {
  RoundHistory round;
  for (std::uint32_t tick = 1; tick <= 700; ++tick) play(round, tick);
  const auto mark = round.popCheckpoint(330);
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark->records, 3300u);
  EXPECT_EQ(mark->players, std::vector<std::uint32_t>{330});
  EXPECT_FALSE(round.popCheckpoint(630)) << "what was after it has not been";
  EXPECT_TRUE(round.popCheckpoint(30));
  EXPECT_FALSE(round.popCheckpoint(30));
}

TEST(RoundHistory, LongRoundKeepsRecordsSinceOldestCheckpoint) {
  RoundHistory round("0123456789");
  for (std::uint32_t tick = 1; tick <= 700; ++tick) play(round, tick);
  EXPECT_TRUE(round.hasBeginning());
  EXPECT_TRUE(round.add(std::string(RoundHistory::kMaxBytes - 7000, 'y')));
  EXPECT_FALSE(round.hasBeginning());
  EXPECT_EQ(round.records().size(), RoundHistory::kMaxBytes + 10 - 310);
  EXPECT_EQ(round.popCheckpoint(630)->records, 6000u);
  EXPECT_EQ(round.popCheckpoint(30)->records, 0u);
}

TEST(RoundHistory, LongRoundWithoutCheckpointsKeepsNothing) {
  RoundHistory round;
  EXPECT_TRUE(round.add(std::string(RoundHistory::kMaxBytes, 'x')));
  EXPECT_FALSE(round.add("y"));
  EXPECT_TRUE(round.records().empty());
}

TEST(RoundHistory, UnfinishedOrFailedCheckpointIsNotKept) {
  RoundHistory round;
  round.beginCheckpoint(30, {}, true);
  EXPECT_FALSE(round.popCheckpoint(30));
  round.beginCheckpoint(60, {}, false);
  EXPECT_FALSE(round.endTick());
  EXPECT_FALSE(round.popCheckpoint(60));
}

}  // namespace
}  // namespace naiad
