// The event feed of a server's watchers, with games that write any number of lines with any bytes.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "host/process/WatchFeed.h"

namespace naiad {
namespace {

class WatchFeedTest : public testing::Test {
 protected:
  WatchFeedTest() {
    feed.begin([] {});
  }

  WatchFeed feed;
  std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
};

TEST_F(WatchFeedTest, LinesOfGamesAreMarkedEscapedAndCut) {
  feed.publishGame("\x1b[31mred\n2026-01-01 00:00:00 a line of the server's", now);
  feed.publishGame(std::string(10 * WatchFeed::kMaxGameLine, 'x'), now);
  const auto events = feed.take().events;
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, "game");
  EXPECT_EQ(events[0].text, "game: \\x1b[31mred\\n2026-01-01 00:00:00 a line of the server's");
  EXPECT_EQ(events[1].text, "game: " + std::string(WatchFeed::kMaxGameLine, 'x'));
}

TEST_F(WatchFeedTest, GameFloodKeepsServerLinesAndIsCounted) {
  constexpr auto kBurst = static_cast<std::size_t>(WatchFeed::kGameRate.burst);
  for (std::size_t i = 0; i < kBurst + 700; ++i) feed.publishGame("flood", now);
  feed.publish("log", "the server's own");
  auto taken = feed.take();
  EXPECT_EQ(taken.dropped, 0u);
  ASSERT_EQ(taken.events.size(), kBurst + 1);
  EXPECT_EQ(taken.events.back().text, "the server's own");
  now += std::chrono::seconds(1);
  feed.publishGame("later", now);
  taken = feed.take();
  ASSERT_EQ(taken.events.size(), 2u);
  EXPECT_EQ(taken.events[0].text, "game: 700 lines dropped (too many at once)");
  EXPECT_EQ(taken.events[1].text, "game: later");
}

TEST_F(WatchFeedTest, WatchedLinesAreStillLogged) {
  std::string logged;
  const LogLine log = [&logged](const LogEvent& event) { logged += event.text + ";"; };
  feed.watched(log)("one");
  feed.watchedGame(log)("two");
  feed.end();
  feed.watchedGame(log)("three");
  EXPECT_EQ(logged, "one;two;three;");
}

}  // namespace
}  // namespace naiad
