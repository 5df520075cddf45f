#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>

#include "host/metrics/HostHealth.h"
#include "host/process/StageClock.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

const HostHealth::Clock::time_point kStart{1h};

class HostHealthTest : public testing::Test {
 protected:
  StageClock stages;
  HostHealth pulse{stages};
};

TEST_F(HostHealthTest, IsHealthyButNotReadyBeforeListening) {
  EXPECT_TRUE(pulse.health(kStart).is_good);
  EXPECT_FALSE(pulse.readiness(kStart).is_good);
  EXPECT_EQ(pulse.readiness(kStart).sentence, "starting");
}

TEST_F(HostHealthTest, NoTickForOverOneSecondIsAHang) {
  stages.start();
  pulse.begin(33ms, kStart);
  stages.beginTick(17, kStart + 500ms, kStart + 500ms);
  EXPECT_TRUE(pulse.health(kStart + 1500ms).is_good);
  EXPECT_TRUE(pulse.readiness(kStart + 1500ms).is_good);
  stages.enter(Stage::kWorld);
  const HostHealth::Result verdict = pulse.health(kStart + 1501ms);
  EXPECT_FALSE(verdict.is_good);
  EXPECT_EQ(verdict.sentence, "no tick has begun for 1.0 s; in tick 17, stage world");
  EXPECT_FALSE(pulse.readiness(kStart + 1501ms).is_good);
  stages.beginTick(18, kStart + 2s, kStart + 2s);
  EXPECT_TRUE(pulse.health(kStart + 2s).is_good);
}

TEST_F(HostHealthTest, HangBeforeFirstTickIsTimedFromTheStart) {
  pulse.begin(33ms, kStart);
  EXPECT_TRUE(pulse.health(kStart + 1s).is_good);
  EXPECT_FALSE(pulse.health(kStart + 1001ms).is_good);
}

TEST_F(HostHealthTest, LongTicksHangAfterTenTickLengths) {
  stages.start();
  pulse.begin(1s, kStart);
  stages.beginTick(1, kStart, kStart);
  EXPECT_TRUE(pulse.health(kStart + 10s).is_good);
  EXPECT_FALSE(pulse.health(kStart + 10'001ms).is_good);
}

TEST_F(HostHealthTest, DrainingIsNotReadyAndHangsOnlyWhileTicking) {
  pulse.begin(33ms, kStart);
  pulse.beginDrain(true);
  EXPECT_FALSE(pulse.readiness(kStart).is_good);
  EXPECT_TRUE(pulse.health(kStart).is_good);
  EXPECT_FALSE(pulse.health(kStart + 2s).is_good);
  pulse.beginDrain(false);
  EXPECT_FALSE(pulse.readiness(kStart).is_good);
  EXPECT_TRUE(pulse.health(kStart + 1h).is_good);
}

TEST(StageClock, TimeBelongsToTheStageInWhichItPassed) {
  StageClock clock;
  clock.start();
  EXPECT_EQ(clock.enter(Stage::kWorld), Stage::kIdle);
  const auto began = StageClock::Clock::now();
  while (StageClock::Clock::now() - began < 2ms) {
  }
  EXPECT_EQ(clock.enter(Stage::kFlush), Stage::kWorld);
  EXPECT_EQ(clock.current(), Stage::kFlush);
  const auto& spent = clock.spent();
  EXPECT_GE(spent[static_cast<std::size_t>(Stage::kWorld)], 2ms);
  EXPECT_EQ(spent[static_cast<std::size_t>(Stage::kFlush)], 0ms);
}

TEST(StageClock, CountsEachTickOnceHoweverOftenItEnds) {
  StageClock clock;
  clock.start();
  const auto now = StageClock::Clock::now();
  clock.beginTick(7, now - 3ms, now);
  clock.endTick();
  clock.endTick();
  EXPECT_EQ(clock.tick(), 7u);
  EXPECT_EQ(clock.tickBegan(), now);
  EXPECT_DOUBLE_EQ(clock.lateness().sum(), 0.003);
  std::uint64_t ended = 0;
  for (std::size_t i = 0; i <= kTickBounds.size(); ++i) ended += clock.durations().count(i);
  EXPECT_EQ(ended, 1u);
}

TEST(StageClock, MeasuresNothingBeforeItIsStarted) {
  StageClock clock;
  clock.beginTick(1, kStart, kStart + 1s);
  clock.endTick();
  EXPECT_EQ(clock.tick(), 0u);
  EXPECT_EQ(clock.lateness().sum(), 0);
  clock.enter(Stage::kWorld);
  clock.enter(Stage::kFlush);
  for (const auto spent : clock.spent()) EXPECT_EQ(spent, 0ms);
}

TEST(StageClock, EveryStageHasANameOfItsOwn) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kStages; ++i) names.insert(nameOf(static_cast<Stage>(i)));
  EXPECT_EQ(names.size(), kStages);
  EXPECT_EQ(names.count("unknown"), 0u);
}

constexpr std::array<double, 3> kBounds{0.001, 0.01, 0.1};

TEST(Histogram, ValueFallsIntoTheSmallestFittingBucket) {
  Histogram histogram(kBounds);
  for (const double value : {-1.0, 0.0, 0.001, 0.0011, 0.01, 0.05, 0.1, 0.11, 1e9}) histogram.add(value);
  EXPECT_EQ(histogram.count(0), 3u);  // a value equal to a bound is below it
  EXPECT_EQ(histogram.count(1), 2u);
  EXPECT_EQ(histogram.count(2), 2u);
  EXPECT_EQ(histogram.count(3), 2u);  // above the last bound
}

TEST(Histogram, BoundsBeyondTheMaximumAreDropped) {
  std::array<double, Histogram::kMaxBounds + 4> many{};
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = static_cast<double>(i);
  Histogram histogram(many);
  histogram.add(1e6);
  EXPECT_EQ(histogram.bounds().size(), Histogram::kMaxBounds);
  EXPECT_EQ(histogram.count(Histogram::kMaxBounds), 1u);
}

}  // namespace
}  // namespace naiad
