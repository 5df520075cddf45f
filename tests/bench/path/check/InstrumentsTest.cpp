#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <vector>

#include "tests/bench/path/judge/EchoJudge.h"
#include "tests/bench/path/judge/FrameJudge.h"
#include "tests/bench/path/link/Link.h"
#include "tests/bench/path/scene/Crowd.h"
#include "tests/bench/path/scene/Status.h"

namespace bench::path {
namespace {

constexpr auto ms = fromMilliseconds;

TEST(Crowd, DependsOnlyOnItsSeed) {
  Crowd a(5), b(5), other(6);
  for (int i = 0; i < 100; ++i) {
    for (Crowd* p_crowd : {&a, &b, &other}) p_crowd->tick();
  }
  EXPECT_EQ(drawScene(a).cells, drawScene(b).cells);
  EXPECT_NE(drawScene(a).cells, drawScene(other).cells);
}

TEST(Crowd, WalkersMoveOnScreenAtTheSpecifiedRates) {
  Crowd crowd(8);
  std::map<std::uint32_t, Walker> before;
  int changed = 0, born = 0, still = 0, running = 0;
  constexpr int kTicks = 5000;
  for (int i = 0; i < kTicks; ++i) {
    for (const Walker& walker : crowd.walkers()) before[walker.id] = walker;
    crowd.tick();
    const auto& walkers = crowd.walkers();
    ASSERT_EQ(walkers.size(), static_cast<std::size_t>(kCrowd));
    ASSERT_TRUE(std::ranges::is_sorted(walkers, {}, &Walker::id));
    for (const Walker& walker : walkers) {
      ASSERT_TRUE(walker.x >= 0 && walker.x <= (kWidth - 1) * kUnits);
      ASSERT_TRUE(walker.y >= 0 && walker.y <= (kHeight - 1) * kUnits);
      still += walker.vx == 0 && walker.vy == 0;
      running += std::abs(walker.vx) == kUnits;
      const auto old = before.find(walker.id);
      if (old == before.end()) {
        ++born;
        continue;
      }
      changed += old->second.ch != walker.ch;
      ASSERT_EQ(walker.x, old->second.x + walker.vx);
      ASSERT_EQ(walker.y, old->second.y + walker.vy);
    }
    before.clear();
  }
  constexpr double kMoves = 1.0 * kCrowd * kTicks;
  EXPECT_NEAR(born / kMoves, 0.002, 0.0003);
  EXPECT_NEAR(changed / kMoves, 0.02 * 25 / 26, 0.001);
  EXPECT_NEAR(still / kMoves, 0.1, 0.02);
  EXPECT_NEAR(running / kMoves, 0.1, 0.02);
}

TEST(Status, CounterCanBeReadBack) {
  Crowd crowd(1);
  for (int i = 0; i < 1234; ++i) crowd.tick();
  Picture picture = drawScene(crowd);
  EXPECT_EQ(counterIn(picture), 1234u);
  picture.at(7, kStatusRow).ch = ' ';
  EXPECT_EQ(counterIn(picture), std::nullopt);
}

TEST(Status, MarkerDistinguishesArrowsModuloFour) {
  for (std::uint32_t arrows = 0; arrows < 9; ++arrows) {
    Picture picture;
    const MarkerCell cell = markerAfter(arrows);
    picture.at(cell.x, cell.y).ch = '@';
    EXPECT_EQ(markerIn(picture), arrows % 4);
    const MarkerCell next = markerAfter(arrows + 1);
    EXPECT_EQ(std::abs(next.x - cell.x) + std::abs(next.y - cell.y), 1) << "it walks";
    picture.at(next.x, next.y).ch = '@';
    EXPECT_EQ(markerIn(picture), std::nullopt) << "half painted";
  }
}

std::vector<std::uint8_t> packet(std::size_t size, std::uint8_t protocol = 6) {
  std::vector<std::uint8_t> bytes(size);
  bytes[0] = 0x45;
  bytes[9] = protocol;
  return bytes;
}

TEST(Direction, DeliversPacketsUnchangedAfterTheDelay) {
  std::atomic<std::uint64_t> bytes{0};
  Direction direction({.delay = std::chrono::milliseconds(50)}, false, 1, bytes);
  direction.take(packet(100), ms(7));
  direction.take(packet(200), ms(9));
  EXPECT_EQ(bytes, 300u);
  for (const auto& [size, due] : {std::pair{100, 57}, {200, 59}}) {
    ASSERT_EQ(direction.next(), ms(due));
    EXPECT_TRUE(direction.pop(*direction.next() - Nanoseconds(1)).packet.empty());
    EXPECT_EQ(direction.pop(*direction.next()).packet, packet(static_cast<std::size_t>(size)));
  }
  EXPECT_FALSE(direction.next());
}

// LossyDatagramLinkTest tests loss, rates and queues.
TEST(Direction, DropsAndCountsTheRightPackets) {
  auto ipv6 = packet(100);
  ipv6[0] = 0x60;
  const struct {
    const char* name;
    std::vector<std::uint8_t> packet;
    double loss;
    bool blocks_udp, is_delivered;
    std::uint64_t counted;
  } rows[] = {{"a lost packet counts", packet(100), 1, false, false, 100},
              {"blocked UDP", packet(100, 17), 0, true, false, 100},
              {"TCP is not blocked", packet(100), 0, true, true, 100},
              {"IPv6", ipv6, 0, false, false, 0},
              {"too short for IPv4", std::vector<std::uint8_t>(3, 0x45), 0, false, false, 0}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    std::atomic<std::uint64_t> bytes{0};
    Direction direction({.loss = row.loss}, row.blocks_udp, 1, bytes);
    direction.take(row.packet, ms(0));
    EXPECT_EQ(direction.next().has_value(), row.is_delivered);
    EXPECT_EQ(bytes, row.counted);
  }
}

const Nanoseconds kEver = ms(1'000'000);

TEST(EchoJudge, MeasuresFromKeyPressToFirstEcho) {
  EchoJudge judge(26);
  EXPECT_EQ(judge.press(ms(100)), 0u);
  EXPECT_EQ(judge.press(ms(300)), 1u);
  judge.look(7, ms(150));  // of a key that was not pressed
  judge.look(std::nullopt, ms(160));
  EXPECT_TRUE(judge.latencies(ms(0), kEver).empty());
  judge.look(0, ms(220));
  judge.look(0, ms(330));
  judge.look(1, ms(450));
  EXPECT_EQ(judge.latencies(ms(0), kEver), (std::vector<double>{120, 150}));
}

TEST(EchoJudge, OneEchoAnswersAllEarlierKeys) {
  EchoJudge judge(26);
  judge.press(ms(100));
  judge.press(ms(110));
  judge.look(1, ms(200));
  EXPECT_EQ(judge.latencies(ms(0), kEver), (std::vector<double>{100, 90}));
}

TEST(EchoJudge, EchoNumbersWrapAround) {
  EchoJudge judge(4);
  for (int i = 0; i < 9; ++i) {
    judge.press(ms(100 * i));
    judge.look(static_cast<std::uint32_t>(i % 4), ms(100 * i + 30 + i));
  }
  EXPECT_EQ(judge.latencies(ms(700), kEver), (std::vector<double>{37, 38}));
}

TEST(EchoJudge, OnlyKeysPressedInTheWindowCount) {
  EchoJudge judge(26);
  for (const int time : {100, 200, 300}) judge.press(ms(time));
  judge.look(0, ms(150));
  judge.look(1, ms(260));
  EXPECT_EQ(judge.latencies(ms(200), ms(300)), (std::vector<double>{60}));
  EXPECT_EQ(judge.unanswered(ms(0), ms(300)), 0u);
  EXPECT_EQ(judge.unanswered(ms(0), ms(301)), 1u);
}

/// Ten ticks of a crowd, one every 100 ms, the first at 100 ms.
class FrameJudgeTest : public testing::Test {
 protected:
  FrameJudgeTest() {
    Crowd crowd(3);
    for (int i = 1; i <= 10; ++i) {
      crowd.tick();
      m_truth->publish(crowd.ticks(), ms(100.0 * i), drawScene(crowd));
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
  m_judge.look(scene(4), ms(450));
  m_judge.look(scene(4), ms(460));
  m_judge.look(scene(5), ms(550));
  ASSERT_EQ(m_judge.shown().size(), 2u);
  EXPECT_EQ(m_judge.shown()[0].at, ms(450));
  EXPECT_EQ(m_judge.shown()[0].start, ms(400));
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
  m_judge.look(mixed(6, 4), ms(700));
  EXPECT_EQ(m_judge.shown().size(), 1u);
  m_judge.look(mixed(8, 5), ms(800));
  EXPECT_EQ(m_judge.shown().size(), 1u);
  EXPECT_LT(m_judge.lastLikeness(), FrameJudge::kLikenessPercent);
}

TEST_F(FrameJudgeTest, TornFrameIsRejectedUnlessLaterCompleted) {
  m_judge.look(mixed(9, 5), ms(600));
  EXPECT_TRUE(m_judge.shown().empty());
  m_judge.look(scene(5), ms(610));
  ASSERT_EQ(m_judge.shown().size(), 1u);
  EXPECT_EQ(m_judge.shown()[0].at, ms(610));
  EXPECT_TRUE(m_judge.refused().empty());
  m_judge.look(mixed(10, 6), ms(700));
  m_judge.look(scene(7), ms(800));
  EXPECT_EQ(m_judge.refused().size(), 1u);
}

TEST_F(FrameJudgeTest, WrongColoursAndCountersAreNotCounted) {
  Picture screen = scene(4);
  for (Cell& cell : screen.cells) cell.color = 1;
  m_judge.look(screen, ms(450));
  EXPECT_TRUE(m_judge.shown().empty());
  m_judge.look(scene(4), ms(640));
  m_judge.look(scene(6), ms(650));
  m_judge.look(mixed(6, 5), ms(660));  // it has decreased
  Picture future = scene(6);
  future.at(5, kStatusRow).ch = '9';
  m_judge.look(future, ms(670));
  EXPECT_EQ(m_judge.shown().size(), 2u);
  EXPECT_TRUE(m_judge.refused().empty());
}

TEST(Fluency, MissingFramesCountAsFreezeAndStaleness) {
  // A frame every 100 ms, each 50 ms late, except those at 500 and 600 ms.
  std::vector<Shown> shown;
  for (int i = 0; i < 10; ++i) {
    if (i != 5 && i != 6)
      shown.push_back({ms(100.0 * i + 50), ms(100.0 * i), static_cast<std::uint32_t>(i + 1)});
  }
  const Fluency fluency = fluencyOf(shown, ms(50), ms(1050));
  EXPECT_DOUBLE_EQ(fluency.frames_per_second, 7);  // of eight frames, the first is shown at the start
  EXPECT_NEAR(fluency.freeze_ms, 300, 1);
  EXPECT_NEAR(fluency.staleness_p50_ms, 113, 15);
  EXPECT_NEAR(fluency.staleness_p99_ms, 340, 2);
}

TEST(Fluency, PeriodWithoutFramesIsAFreeze) {
  const Fluency fluency = fluencyOf({{ms(10), ms(0), 1}}, ms(20), ms(520));
  EXPECT_NEAR(fluency.freeze_ms, 510, 1e-9);
  EXPECT_EQ(fluency.frames_per_second, 0);
  // Before the first frame, the staleness is unknown.
  EXPECT_TRUE(std::isnan(fluencyOf({{ms(100), ms(0), 1}}, ms(20), ms(520)).staleness_p50_ms));
}

}  // namespace
}  // namespace bench::path
