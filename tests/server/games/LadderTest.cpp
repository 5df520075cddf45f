// Properties of all shipped games: players press random keys, join and leave at random, and after 1,000 ticks
// the hash of their pictures is equal for every compiler. Their help texts fit.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "GameMains.h"
#include "HostedGame.h"
#include "RandomPlayers.h"
#include "shared/net/base/Limits.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

struct Game {
  const char* name;
  std::uint64_t hash;
};

void PrintTo(const Game& game, std::ostream* p_out) {
  *p_out << game.name;
}

class Ladder : public ::testing::TestWithParam<Game> {};

TEST_P(Ladder, AThousandTicksShowTheSamePicturesEverywhere) {
  PictureHash hash;
  int ticks = 0;
  hostGame(
      gameMains().at(GetParam().name), 7,
      [&](df::World& world) {
        RandomPlayers players(world, 7, 4);
        for (; ticks < 1000; ++ticks) {
          players.play();
          world.tick();
          for (const std::uint32_t player : players.players()) hash.add(world.picture().renderPlayer(player));
        }
      },
      GetParam().name);
  EXPECT_EQ(ticks, 1000);
  char text[32];
  std::snprintf(text, sizeof text, "0x%016llx", static_cast<unsigned long long>(hash.value()));
  EXPECT_EQ(hash.value(), GetParam().hash) << "it is " << text << "; another game has another number";
}

TEST_P(Ladder, EightJoiningAndLeavingPlayersBreakNothing) {
  for (std::uint64_t seed = 1; seed <= (test::kSanitized ? 1 : 2); ++seed) {
    hostGame(
        gameMains().at(GetParam().name), seed,
        [&](df::World& world) {
          RandomPlayers players(world, seed, 8);
          int quarantined = 0;
          world.log().setSink(
              [&](const std::string& line) { quarantined += line.find("failed") != std::string::npos; });
          for (int t = 0; t < 800; ++t) {
            players.play();
            world.tick();
            ASSERT_LT(world.store().countInWorld(), 2200);
          }
          EXPECT_EQ(quarantined, 0);
          EXPECT_EQ(world.log().refusals(), 0u);
          for (const std::uint32_t player : players.players()) world.input().leave(player);
          for (int t = 0; t < 100; ++t) world.tick();
        },
        GetParam().name);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Games, Ladder,
    ::testing::Values(Game{"breakout", 0xbce01429f5cdc6c9}, Game{"bullethell", 0xad804e66e5638c57},
                      Game{"chase", 0x340062b8544b9848}, Game{"hello", 0xe45e0ba05e3fc998},
                      Game{"lander", 0xe2c224ec6152eb3f}, Game{"maze", 0xbafc29fa70221cdd},
                      Game{"platformer", 0x821a44b3bea0d158}, Game{"sandbox", 0x6ee2df9e4463e198},
                      Game{"saucershoot", 0x6e8fab27e05d1b2f}, Game{"tron", 0x55e0d957d53b5a66}),
    [](const auto& game) { return std::string(game.param.name); });

TEST(Help, EveryGamesHelpFitsItsWindowAndProtocol) {
  for (const auto& [game, game_main] : gameMains()) {
    const std::string name = game;  // because clang cannot capture structured bindings
    bool played = false;
    hostGame(
        game_main, 1,
        [&](df::World& world) {
          played = true;
          EXPECT_FALSE(world.getHelp().empty()) << name;
          EXPECT_LE(world.getHelp().size(), kMaxHelpLines) << name;
          for (const std::string& line : world.getHelp()) {
            EXPECT_LE(line.size(), kMaxHelpLength) << name << ": " << line;
            EXPECT_LE(static_cast<int>(line.size()), world.views().width()) << name << ": " << line;
          }
        },
        name);
    EXPECT_TRUE(played) << name;
  }
}

TEST(Help, TestsCoverEveryGameFolder) {
  std::set<std::string> folders, names;
  for (const auto& entry : std::filesystem::directory_iterator(NAIAD_SOURCE_DIR "/server/games"))
    if (entry.is_directory()) folders.insert(entry.path().filename());
  for (const auto& [name, game_main] : gameMains()) names.insert(name);
  EXPECT_EQ(names, folders);
}

}  // namespace
}  // namespace naiad
