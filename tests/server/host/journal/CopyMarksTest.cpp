// When copies of a world are due, and where in the round they are.
#include <gtest/gtest.h>

#include "host/journal/CopyMarks.h"

namespace naiad {
namespace {

using std::chrono::milliseconds;

/// A tick in which a copy is kept if one is due. True: one was. Each tick takes `time`.
bool play(CopyMarks& marks, std::uint32_t tick, milliseconds time = milliseconds(0)) {
  const bool due = marks.isDue(tick, [&] { return tick * time; });
  if (due) marks.beginTick(tick, {tick}, true);
  EXPECT_EQ(marks.endTick(tick * 10), due);
  return due;
}

TEST(CopyMarks, TheFirstIsDueSoonAndOthersFollowInTime) {
  CopyMarks marks;
  std::vector<std::uint32_t> due;
  for (std::uint32_t tick = 1; tick <= 700; ++tick) {
    if (play(marks, tick)) due.push_back(tick);
  }
  EXPECT_EQ(due, (std::vector<std::uint32_t>{30, 330, 630}));
}

TEST(CopyMarks, WhereTicksTakeLongTheyAreDueMoreOften) {
  CopyMarks marks;
  std::vector<std::uint32_t> due;
  for (std::uint32_t tick = 1; tick <= 300; ++tick) {
    if (play(marks, tick, milliseconds(1))) due.push_back(tick);
  }
  EXPECT_EQ(due, (std::vector<std::uint32_t>{30, 150, 270}));
}

TEST(CopyMarks, OneThatGoesOnLeavesThoseBeforeIt) {
  CopyMarks marks;
  for (std::uint32_t tick = 1; tick <= 700; ++tick) play(marks, tick);
  const auto mark = marks.take(330);
  ASSERT_TRUE(mark);
  EXPECT_EQ(mark->records, 3300u);
  EXPECT_EQ(mark->players, std::vector<std::uint32_t>{330});
  EXPECT_FALSE(marks.take(630)) << "what was after it has not been";
  EXPECT_TRUE(marks.take(30));
  EXPECT_FALSE(marks.take(30));
}

TEST(CopyMarks, OfATickWithoutAResultThereIsNone) {
  CopyMarks marks;
  marks.beginTick(30, {}, true);
  EXPECT_FALSE(marks.take(30));
  marks.beginTick(60, {}, false);
  EXPECT_FALSE(marks.endTick(100));
  EXPECT_FALSE(marks.take(60));
}

}  // namespace
}  // namespace naiad
