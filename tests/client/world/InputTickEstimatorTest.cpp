#include <gtest/gtest.h>

#include <chrono>

#include "client/world/InputTickEstimator.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
constexpr DisplayClock::Duration kTickTime = std::chrono::milliseconds(40);

class InputTickEstimatorTest : public testing::Test {
 protected:
  InputTickEstimatorTest() {
    for (std::uint32_t tick = 100; tick <= 200; ++tick, now += kTickTime) clock.onSnapshot(tick, now);
    now -= kTickTime;
  }
  /// Returns how many ticks after the newest one a key is requested for.
  std::uint32_t ahead() const { return take_in.tickFor(clock, kTickTime, now) - clock.newestTick(); }

  DisplayClock::Time now{std::chrono::hours(1)};
  DisplayClock clock{kTickTime};
  InputTickEstimator take_in;
};

TEST_F(InputTickEstimatorTest, RoundTripAdvancesTheEstimate) {
  take_in.addRttSample(100ms);  // two and a half ticks, plus the margin
  EXPECT_EQ(ahead(), 3u);
  InputTickEstimator far;
  far.addRttSample(400ms);
  EXPECT_EQ(far.tickFor(clock, kTickTime, now) - clock.newestTick(), 11u);
}

TEST_F(InputTickEstimatorTest, UsesTheShortestOfTheLastEightRoundTrips) {
  take_in.addRttSample(400ms);
  take_in.addRttSample(40ms);
  EXPECT_EQ(ahead(), 2u);
  for (int i = 0; i < 7; ++i) take_in.addRttSample(400ms);
  EXPECT_EQ(ahead(), 2u);
  take_in.addRttSample(400ms);
  EXPECT_EQ(ahead(), 11u);
}

TEST_F(InputTickEstimatorTest, EstimatesTheNextTickAndAdvancesWithTime) {
  EXPECT_EQ(ahead(), 1u);
  now += 3 * kTickTime;
  EXPECT_EQ(ahead(), 4u);
}

TEST_F(InputTickEstimatorTest, EstimateIsLimitedDuringSilence) {
  now += 1000 * kTickTime;
  EXPECT_EQ(ahead(), 1 + DisplayClock::kMaxAhead / kTickTime);
  take_in.addRttSample(std::chrono::hours(1));
  EXPECT_EQ(ahead(), 61u);
}

TEST_F(InputTickEstimatorTest, LateInputsWidenTheMarginOthersNarrowIt) {
  EXPECT_EQ(take_in.margin(), InputTickEstimator::kMinMargin);
  take_in.onInputApplied(10, 11);
  EXPECT_DOUBLE_EQ(take_in.margin(), InputTickEstimator::kMinMargin + InputTickEstimator::kGrow);
  take_in.onInputApplied(11, 11);
  EXPECT_DOUBLE_EQ(take_in.margin(),
                   InputTickEstimator::kMinMargin + InputTickEstimator::kGrow - InputTickEstimator::kShrink);
  for (int i = 0; i < 1000; ++i) take_in.onInputApplied(10, 12);
  EXPECT_EQ(take_in.margin(), InputTickEstimator::kMaxMargin);
  for (int i = 0; i < 10'000; ++i) take_in.onInputApplied(12, 12);
  EXPECT_EQ(take_in.margin(), InputTickEstimator::kMinMargin);
}

TEST_F(InputTickEstimatorTest, TicksMayWrapAround) {
  take_in.onInputApplied(UINT32_MAX, 1);
  EXPECT_GT(take_in.margin(), InputTickEstimator::kMinMargin);
  InputTickEstimator other;
  other.onInputApplied(1, UINT32_MAX);
  EXPECT_EQ(other.margin(), InputTickEstimator::kMinMargin);
}

// The margin neither grows nor shrinks if this share of the inputs is late.
TEST_F(InputTickEstimatorTest, MarginBalancesAtOneLateInputInForty) {
  const auto drift = [](int every) {
    InputTickEstimator other;
    for (int i = 0; i < 10; ++i) other.onInputApplied(0, 1);
    const double before = other.margin();
    for (int i = 1; i <= 400; ++i) other.onInputApplied(0, i % every == 0 ? 1 : 0);
    return other.margin() - before;
  };
  EXPECT_GT(drift(30), 0.1);
  EXPECT_LT(drift(50), -0.1);
}

}  // namespace
}  // namespace naiad
