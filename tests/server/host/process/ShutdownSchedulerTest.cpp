// Planned shutdowns of a server, and the announcements to its players.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "host/process/ShutdownScheduler.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class ShutdownSchedulerTest : public testing::Test {
 protected:
  std::string news() { return scheduler.popNotice(now).value_or(""); }

  ShutdownScheduler scheduler;
  const ShutdownScheduler::Time begin{1h};
  ShutdownScheduler::Time now = begin;
};

TEST_F(ShutdownSchedulerTest, IsNotDueWithoutAPlan) {
  EXPECT_FALSE(scheduler.isDue(now, true));
  EXPECT_TRUE(scheduler.acceptsPlayers());
  EXPECT_EQ(news(), "");
  EXPECT_EQ(scheduler.sentence(), "");
  EXPECT_FALSE(scheduler.cancel());
}

TEST_F(ShutdownSchedulerTest, DrainEndsWhenEmptyOrAtItsDeadline) {
  scheduler.setPlan({.at = begin + 60s, .when_empty = true}, now);
  EXPECT_FALSE(scheduler.acceptsPlayers()) << "who comes now would keep it from ending";
  EXPECT_FALSE(scheduler.isDue(now, false));
  EXPECT_TRUE(scheduler.isDue(now, true));
  EXPECT_FALSE(scheduler.isDue(begin + 60s - 1ns, false));
  EXPECT_TRUE(scheduler.isDue(begin + 60s, false));
  EXPECT_EQ(scheduler.sentence(), "The server is shutting down.");
}

TEST_F(ShutdownSchedulerTest, ShutdownIsAnnouncedAtOnceAndTenSecondsBefore) {
  scheduler.setPlan({.at = begin + 60s, .when_empty = true}, now);
  EXPECT_EQ(news(), "The server shuts down when all players have left, or in 60 seconds at the latest.");
  for (; now < begin + 50s; now += 33ms) EXPECT_EQ(news(), "");
  EXPECT_EQ(news(), "The server shuts down when all players have left, or in 10 seconds at the latest.");
  for (; now < begin + 61s; now += 33ms) EXPECT_EQ(news(), "");
}

TEST_F(ShutdownSchedulerTest, ShortNoticeIsAnnouncedOnce) {
  scheduler.setPlan({.is_restart = true, .at = begin + 1s}, now);
  EXPECT_EQ(news(), "The server restarts in 1 second. Your client reconnects automatically.");
  for (; now < begin + 2s; now += 33ms) EXPECT_EQ(news(), "");
}

TEST_F(ShutdownSchedulerTest, ImmediateShutdownSendsOnlyTheFinalMessage) {
  scheduler.setPlan({.at = now, .sentence = "Bye."}, now);
  EXPECT_EQ(news(), "");
  EXPECT_TRUE(scheduler.isDue(now, false));
  EXPECT_EQ(scheduler.sentence(), "Bye.");
}

TEST_F(ShutdownSchedulerTest, RestartAtRoundEndWaitsAndAdmitsPlayers) {
  scheduler.setPlan({.is_restart = true, .at_round_end = true}, now);
  EXPECT_TRUE(scheduler.acceptsPlayers() && scheduler.isRestart());
  EXPECT_EQ(news(), "The server restarts when this round is over. Your client reconnects automatically.");
  EXPECT_EQ(news(), "");
  EXPECT_FALSE(scheduler.isDue(begin + 24h, true));
  EXPECT_EQ(scheduler.sentence(), "The server is restarting. Your client reconnects automatically.");
}

TEST_F(ShutdownSchedulerTest, PlanCanBeCancelledAndSetAgain) {
  scheduler.setPlan({.at = begin + 60s, .when_empty = true}, now);
  news();
  EXPECT_TRUE(scheduler.cancel());
  EXPECT_TRUE(scheduler.acceptsPlayers());
  EXPECT_FALSE(scheduler.isDue(begin + 1h, true));
  scheduler.setPlan({.at = begin + 30s}, now);
  EXPECT_EQ(news(), "The server shuts down in 30 seconds.");
}

}  // namespace
}  // namespace naiad
