// The event feed of a server's watchers, with games that write any number of lines with any bytes.
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "host/process/EventFeed.h"

namespace naiad {
namespace {

class EventFeedTest : public testing::Test {
 protected:
  EventFeedTest() {
    feed.begin([] {});
  }

  EventFeed feed;
  std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
};

TEST_F(EventFeedTest, LinesOfGamesAreMarkedEscapedAndCut) {
  feed.publishGame("\x1b[31mred\n2026-01-01 00:00:00 a line of the server's", now);
  feed.publishGame(std::string(10 * EventFeed::kMaxGameLine, 'x'), now);
  const auto events = feed.popAll().events;
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].kind, "game");
  EXPECT_EQ(events[0].text, "game: \\x1b[31mred\\n2026-01-01 00:00:00 a line of the server's");
  EXPECT_EQ(events[1].text, "game: " + std::string(EventFeed::kMaxGameLine, 'x'));
}

TEST_F(EventFeedTest, GameFloodKeepsServerLinesAndIsCounted) {
  constexpr auto kBurst = static_cast<std::size_t>(EventFeed::kGameRate.burst);
  for (std::size_t i = 0; i < kBurst + 700; ++i) feed.publishGame("flood", now);
  feed.publish("log", "the server's own");
  auto batch = feed.popAll();
  EXPECT_EQ(batch.dropped, 0u);
  ASSERT_EQ(batch.events.size(), kBurst + 1);
  EXPECT_EQ(batch.events.back().text, "the server's own");
  now += std::chrono::seconds(1);
  feed.publishGame("later", now);
  batch = feed.popAll();
  ASSERT_EQ(batch.events.size(), 2u);
  EXPECT_EQ(batch.events[0].text, "game: 700 lines dropped (too many at once)");
  EXPECT_EQ(batch.events[1].text, "game: later");
}

TEST_F(EventFeedTest, WatchedLinesAreStillLogged) {
  std::string logged;
  const LogLine log = [&logged](const LogEvent& event) { logged += event.text + ";"; };
  feed.publishing(log)("one");
  feed.publishingGame(log)("two");
  feed.end();
  feed.publishingGame(log)("three");
  EXPECT_EQ(logged, "one;two;three;");
}

}  // namespace
}  // namespace naiad
