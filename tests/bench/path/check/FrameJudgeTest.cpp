#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/bench/path/Monotonic.h"
#include "tests/bench/path/judge/FrameJudge.h"
#include "tests/bench/path/scene/Crowd.h"
#include "tests/bench/path/scene/Status.h"

namespace bench::path {
namespace {

/// Ten ticks of a crowd, one every 100 ms, the first at 100 ms.
class FrameJudgeTest : public testing::Test {
 protected:
  FrameJudgeTest() {
    Crowd crowd(3);
    for (int i = 1; i <= 10; ++i) {
      crowd.tick();
      m_truth->publish(crowd.ticks(), fromMilliseconds(100.0 * i), drawScene(crowd));
    }
  }
  const Picture& scene(std::uint32_t tick) const { return m_truth->find(tick)->picture; }
  /// Returns a picture with the crowd of one tick and the counter of another.
  Picture mixed(std::uint32_t crowd_tick, std::uint32_t counter) const {
    Picture picture = scene(crowd_tick);
    for (int x = 0; x < kEchoColumn; ++x) picture.at(x, kStatusRow) = scene(counter).at(x, kStatusRow);
    return picture;
  }

  const std::unique_ptr<Truth> m_truth = std::make_unique<Truth>();
  FrameJudge m_judge{*m_truth};
};

TEST_F(FrameJudgeTest, CorrectFramesCountOnce) {
  m_judge.look(scene(4), fromMilliseconds(450));
  m_judge.look(scene(4), fromMilliseconds(460));
  m_judge.look(scene(5), fromMilliseconds(550));
  ASSERT_EQ(m_judge.shown().size(), 2u);
  EXPECT_EQ(m_judge.shown()[0].at, fromMilliseconds(450));
  EXPECT_EQ(m_judge.shown()[0].start, fromMilliseconds(400));
  EXPECT_EQ(m_judge.shown()[1].tick, 5u);
  EXPECT_TRUE(m_judge.refused().empty());
}

TEST_F(FrameJudgeTest, EchoAndMarkerAreNotJudged) {
  Picture screen = scene(4);
  screen.at(kEchoColumn, kStatusRow) = {'q', 7};
  screen.at(kMarkerColumn + 1, kMarkerRow) = {'@', 7};
  EXPECT_EQ(likeness(screen, scene(4)), 100);
}

TEST_F(FrameJudgeTest, CrowdMayDifferFromTheCounterByTwoTicks) {
  m_judge.look(mixed(6, 4), fromMilliseconds(700));
  EXPECT_EQ(m_judge.shown().size(), 1u);
  m_judge.look(mixed(8, 5), fromMilliseconds(800));
  EXPECT_EQ(m_judge.shown().size(), 1u);
  EXPECT_LT(m_judge.lastLikeness(), FrameJudge::kLikenessPercent);
}

TEST_F(FrameJudgeTest, TornFrameIsRejectedUnlessLaterCompleted) {
  Picture torn = mixed(9, 5);
  m_judge.look(torn, fromMilliseconds(600));
  EXPECT_TRUE(m_judge.shown().empty());
  m_judge.look(scene(5), fromMilliseconds(610));
  ASSERT_EQ(m_judge.shown().size(), 1u);
  EXPECT_EQ(m_judge.shown()[0].at, fromMilliseconds(610));
  EXPECT_TRUE(m_judge.refused().empty());
  m_judge.look(mixed(10, 6), fromMilliseconds(700));
  m_judge.look(scene(7), fromMilliseconds(800));
  EXPECT_EQ(m_judge.refused().size(), 1u);
}

TEST_F(FrameJudgeTest, FrameInWrongColoursIsNotCounted) {
  Picture screen = scene(4);
  for (Cell& cell : screen.cells) cell.color = 1;
  m_judge.look(screen, fromMilliseconds(450));
  EXPECT_TRUE(m_judge.shown().empty());
}

TEST_F(FrameJudgeTest, FutureAndDecreasingCountersAreIgnored) {
  m_judge.look(scene(6), fromMilliseconds(650));
  m_judge.look(mixed(6, 5), fromMilliseconds(660));
  Picture future = scene(6);
  future.at(5, kStatusRow).ch = '9';
  m_judge.look(future, fromMilliseconds(670));
  EXPECT_EQ(m_judge.shown().size(), 1u);
  EXPECT_TRUE(m_judge.refused().empty());
}

TEST(Fluency, MissingFramesCountAsFreezeAndStaleness) {
  // A frame every 100 ms, each 50 ms late, except those at 500 and 600 ms.
  std::vector<Shown> shown;
  for (int i = 0; i < 10; ++i) {
    if (i != 5 && i != 6)
      shown.push_back(
          {fromMilliseconds(100.0 * i + 50), fromMilliseconds(100.0 * i), static_cast<std::uint32_t>(i + 1)});
  }
  const Fluency fluency = fluencyOf(shown, fromMilliseconds(50), fromMilliseconds(1050));
  EXPECT_DOUBLE_EQ(fluency.frames_per_second, 7);  // of eight frames, the first is shown at the start
  EXPECT_NEAR(fluency.freeze_ms, 300, 1);
  EXPECT_NEAR(fluency.staleness_p50_ms, 113, 15);
  EXPECT_NEAR(fluency.staleness_p99_ms, 340, 2);
}

TEST(Fluency, PeriodWithoutFramesIsAFreeze) {
  const Fluency fluency = fluencyOf({{fromMilliseconds(10), fromMilliseconds(0), 1}}, fromMilliseconds(20),
                                    fromMilliseconds(520));
  EXPECT_NEAR(fluency.freeze_ms, 510, 1e-9);
  EXPECT_EQ(fluency.frames_per_second, 0);
}

TEST(Fluency, StalenessIsUnknownBeforeTheFirstFrame) {
  EXPECT_TRUE(std::isnan(fluencyOf({{fromMilliseconds(100), fromMilliseconds(0), 1}}, fromMilliseconds(20),
                                   fromMilliseconds(520))
                             .staleness_p50_ms));
}

}  // namespace
}  // namespace bench::path
