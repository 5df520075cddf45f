#include <gtest/gtest.h>

#include <map>
#include <string>

#include "host/rooms/PlayerListBroadcaster.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

class PlayerListBroadcasterTest : public testing::Test {
 protected:
  void play(int players) {
    facts.clear();
    for (int i = 1; i <= players; ++i)
      facts.push_back({.id = static_cast<std::uint32_t>(i), .name = std::to_string(i)});
  }
  /// Runs the ticks. Returns the last list that each player got, as names.
  std::map<std::uint32_t, std::vector<std::string>> listsSent(std::uint32_t from, std::uint32_t to) {
    std::map<std::uint32_t, std::vector<std::string>> heard;
    for (std::uint32_t tick = from; tick < to; ++tick) {
      news.tick(
          tick, facts, [](std::uint32_t player) { return player; },
          [&](std::uint32_t player, const wire::ServerMessage& message) {
            ++messages;
            EXPECT_LE(message.ByteSizeLong(), kMaxServerFrame);
            heard[player].clear();
            for (const auto& entry : message.players().players()) heard[player].push_back(entry.name());
          });
    }
    return heard;
  }
  PlayerListBroadcaster news;
  std::vector<ListedPlayer> facts;
  int messages = 0;
};

TEST_F(PlayerListBroadcasterTest, ChangedListIsSentInFullToAllPlayers) {
  play(3);
  EXPECT_EQ(listsSent(1, 16).size(), 3u);
  EXPECT_EQ(listsSent(16, 100).size(), 0u) << "nothing has changed";
  news.repeat();
  EXPECT_EQ(listsSent(100, 120).size(), 3u);
  facts[1].score = 7;
  const auto heard = listsSent(120, 150);
  EXPECT_EQ(heard.at(3), (std::vector<std::string>{"1", "2", "3"}));
}

TEST_F(PlayerListBroadcasterTest, ListOfTheLongestNamesFitsAFrame) {
  play(static_cast<int>(kMaxPlayers));
  for (auto& player : facts) {
    player.id += 100'000;
    player.name = std::string(kMaxNameBytes, 'x');
    player.score = -1'000'000'000;
  }
  const auto heard = listsSent(1, 16);  // also checks the length of each message
  EXPECT_EQ(heard.size(), facts.size());
  EXPECT_GT(heard.begin()->second.size(), kMaxPlayers / 2);
}

TEST_F(PlayerListBroadcasterTest, LargeListsHaveOnlyBestAndOwnEntries) {
  const int many = static_cast<int>(kMaxPlayers) + 800;
  play(many);
  facts[899].score = 5;
  const auto heard = listsSent(1, 1 + PlayerListBroadcaster::kCrowdInterval);
  EXPECT_EQ(heard.size(), facts.size()) << "each player got one";
  EXPECT_EQ(messages, many) << "once";
  EXPECT_EQ(heard.at(500).size(), PlayerListBroadcaster::kCrowdEntries + 1);
  EXPECT_EQ(heard.at(500).front(), "900");
  EXPECT_EQ(heard.at(500).back(), "500");
  EXPECT_EQ(heard.at(900).size(), PlayerListBroadcaster::kCrowdEntries) << "is among the best";
}

TEST_F(PlayerListBroadcasterTest, NoTickSendsMoreThanItsShare) {
  play(1500);
  for (std::uint32_t tick = 1; tick < 400; ++tick) {
    messages = 0;
    listsSent(tick, tick + 1);
    EXPECT_LE(messages, 10) << tick;
  }
}

}  // namespace
}  // namespace naiad
