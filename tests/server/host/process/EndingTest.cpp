// Planned shutdowns of a server, and the announcements to its players.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "host/process/Ending.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class EndingTest : public testing::Test {
 protected:
  std::string news() { return ending.takeNews(now).value_or(""); }

  Ending ending;
  const Ending::Time begin{1h};
  Ending::Time now = begin;
};

TEST_F(EndingTest, IsNotDueWithoutAPlan) {
  EXPECT_FALSE(ending.isDue(now, true));
  EXPECT_TRUE(ending.isOpen());
  EXPECT_EQ(news(), "");
  EXPECT_EQ(ending.sentence(), "");
  EXPECT_FALSE(ending.cancel());
}

TEST_F(EndingTest, DrainEndsWhenEmptyOrAtItsDeadline) {
  ending.setPlan({.at = begin + 60s, .when_empty = true}, now);
  EXPECT_FALSE(ending.isOpen()) << "who comes now would keep it from ending";
  EXPECT_FALSE(ending.isDue(now, false));
  EXPECT_TRUE(ending.isDue(now, true));
  EXPECT_FALSE(ending.isDue(begin + 60s - 1ns, false));
  EXPECT_TRUE(ending.isDue(begin + 60s, false));
  EXPECT_EQ(ending.sentence(), "The server is shutting down.");
}

TEST_F(EndingTest, ShutdownIsAnnouncedAtOnceAndTenSecondsBefore) {
  ending.setPlan({.at = begin + 60s, .when_empty = true}, now);
  EXPECT_EQ(news(), "The server shuts down when all players have left, or in 60 seconds at the latest.");
  for (; now < begin + 50s; now += 33ms) EXPECT_EQ(news(), "");
  EXPECT_EQ(news(), "The server shuts down when all players have left, or in 10 seconds at the latest.");
  for (; now < begin + 61s; now += 33ms) EXPECT_EQ(news(), "");
}

TEST_F(EndingTest, ShortNoticeIsAnnouncedOnce) {
  ending.setPlan({.begins_again = true, .at = begin + 1s}, now);
  EXPECT_EQ(news(), "The server restarts in 1 second. Your client reconnects automatically.");
  for (; now < begin + 2s; now += 33ms) EXPECT_EQ(news(), "");
}

TEST_F(EndingTest, ImmediateShutdownSendsOnlyTheFinalMessage) {
  ending.setPlan({.at = now, .sentence = "Bye."}, now);
  EXPECT_EQ(news(), "");
  EXPECT_TRUE(ending.isDue(now, false));
  EXPECT_EQ(ending.sentence(), "Bye.");
}

TEST_F(EndingTest, RestartAtRoundEndWaitsAndAdmitsPlayers) {
  ending.setPlan({.begins_again = true, .at_round_end = true}, now);
  EXPECT_TRUE(ending.isOpen() && ending.beginsAgain());
  EXPECT_EQ(news(), "The server restarts when this round is over. Your client reconnects automatically.");
  EXPECT_EQ(news(), "");
  EXPECT_FALSE(ending.isDue(begin + 24h, true));
  EXPECT_EQ(ending.sentence(), "The server is restarting. Your client reconnects automatically.");
}

TEST_F(EndingTest, PlanCanBeCancelledAndSetAgain) {
  ending.setPlan({.at = begin + 60s, .when_empty = true}, now);
  news();
  EXPECT_TRUE(ending.cancel());
  EXPECT_TRUE(ending.isOpen());
  EXPECT_FALSE(ending.isDue(begin + 1h, true));
  ending.setPlan({.at = begin + 30s}, now);
  EXPECT_EQ(news(), "The server shuts down in 30 seconds.");
}

}  // namespace
}  // namespace naiad
