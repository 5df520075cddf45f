#include <gtest/gtest.h>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <memory>
#include <thread>

#include "shared/net/stream/StallTolerantTimer.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

struct StallTolerantTimerTest : testing::Test {
  void start(StallTolerantTimer::Duration time) {
    timer->start(time, [this, keep = timer] { ++calls; });
  }
  asio::io_context context;
  std::shared_ptr<StallTolerantTimer> timer = std::make_shared<StallTolerantTimer>(context);
  int calls = 0;
};

TEST_F(StallTolerantTimerTest, CallsOnceAndNotBeforeItsTime) {
  const auto began = std::chrono::steady_clock::now();
  start(24ms);
  context.run();
  EXPECT_GE(std::chrono::steady_clock::now() - began, 24ms);
  EXPECT_EQ(calls, 1);
}

TEST_F(StallTolerantTimerTest, AbsenceCountsOnlyAsOnePart) {
  start(8ms);
  std::this_thread::sleep_for(16ms);  // time in which the context does not run
  for (int part = 1; part < StallTolerantTimer::kParts; ++part) {
    EXPECT_EQ(context.run_one(), 1u);
    EXPECT_EQ(calls, 0) << "what came meanwhile has its turn first";
  }
  context.run();
  EXPECT_EQ(calls, 1);
}

TEST_F(StallTolerantTimerTest, CancelledTimerDoesNotCallAndReleasesItself) {
  start(1h);
  timer->cancel();
  context.run();
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(timer.use_count(), 1);
}

TEST_F(StallTolerantTimerTest, TimerCancelledAfterExpiryDoesNotCall) {
  start(8ms);
  std::this_thread::sleep_for(16ms);
  asio::post(context, [this] { timer->cancel(); });
  context.run();
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(timer.use_count(), 1);
}

TEST_F(StallTolerantTimerTest, RestartReplacesTheEarlierTime) {
  start(1h);
  start(8ms);
  context.run();
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace naiad
