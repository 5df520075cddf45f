#include <gtest/gtest.h>

#include <map>
#include <string>

#include "host/program/PlayerNews.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

class PlayerNewsTest : public testing::Test {
 protected:
  void play(int players) {
    facts.clear();
    for (int i = 1; i <= players; ++i) {
      df::PlayerFacts player;
      player.id = static_cast<std::uint32_t>(i);
      player.name = std::to_string(i);
      facts.push_back(player);
    }
  }
  /// Who was told in these ticks, and what last.
  std::map<std::uint32_t, std::vector<std::string>> told(std::uint32_t from, std::uint32_t to) {
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
  PlayerNews news;
  std::vector<df::PlayerFacts> facts;
  int messages = 0;
};

TEST_F(PlayerNewsTest, AllHearOfAllWhenSomethingIsNew) {
  play(3);
  EXPECT_EQ(told(1, 16).size(), 3u);
  EXPECT_EQ(told(16, 100).size(), 0u) << "nothing new";
  news.repeat();
  EXPECT_EQ(told(100, 120).size(), 3u);
  facts[1].score = 7;
  const auto heard = told(120, 150);
  EXPECT_EQ(heard.at(3), (std::vector<std::string>{"1", "2", "3"}));
}

TEST_F(PlayerNewsTest, InACrowdEachHearsOfTheBestAndOfHimself) {
  const int many = static_cast<int>(kMaxPlayers) + 800;
  play(many);
  facts[899].score = 5;
  const auto heard = told(1, 1 + PlayerNews::kCrowdEvery);
  EXPECT_EQ(heard.size(), facts.size()) << "everybody has had his turn";
  EXPECT_EQ(messages, many) << "once";
  EXPECT_EQ(heard.at(500).size(), PlayerNews::kCrowdEntries + 1);
  EXPECT_EQ(heard.at(500).front(), "900");
  EXPECT_EQ(heard.at(500).back(), "500");
  EXPECT_EQ(heard.at(900).size(), PlayerNews::kCrowdEntries) << "among the best himself";
}

TEST_F(PlayerNewsTest, NoTickTellsMoreThanItsShare) {
  play(1500);
  for (std::uint32_t tick = 1; tick < 400; ++tick) {
    messages = 0;
    told(tick, tick + 1);
    EXPECT_LE(messages, 10) << tick;
  }
}

}  // namespace
}  // namespace naiad
