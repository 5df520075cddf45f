// Tests the help text of all shipped games.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "GameMains.h"
#include "HostedGame.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

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
