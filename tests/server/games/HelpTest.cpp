// What all games have in common.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "HostedGame.h"
#include "shared/net/base/Limits.h"

int breakout_main();
int bullethell_main();
int chase_main();
int hello_main();
int lander_main();
int maze_main();
int platformer_main();
int sandbox_main();
int saucershoot_main();
int tron_main();

namespace naiad {
namespace {

const std::map<std::string, int (*)()>& games() {
  static const std::map<std::string, int (*)()> s_games = {{"breakout", breakout_main},
                                                           {"bullethell", bullethell_main},
                                                           {"chase", chase_main},
                                                           {"hello", hello_main},
                                                           {"lander", lander_main},
                                                           {"maze", maze_main},
                                                           {"platformer", platformer_main},
                                                           {"sandbox", sandbox_main},
                                                           {"saucershoot", saucershoot_main},
                                                           {"tron", tron_main}};
  return s_games;
}

TEST(Help, OfEveryGameIsThereAndFitsItsWindowAndTheProtocol) {
  for (const auto& [name, game_main] : games()) {
    bool played = false;
    hostGame(
        game_main, 1,
        [&](df::World& world) {
          played = true;
          EXPECT_FALSE(world.getHelp().empty()) << name;
          EXPECT_LE(world.getHelp().size(), kMaxHelpLines) << name;
          for (const std::string& line : world.getHelp()) {
            EXPECT_LE(line.size(), kMaxHelpLength) << name << ": " << line;
            EXPECT_LE(static_cast<int>(line.size()), world.getWindowWidth()) << name << ": " << line;
          }
        },
        name);
    EXPECT_TRUE(played) << name;
  }
}

TEST(Help, IsAskedOfEveryGameThatThereIs) {
  std::set<std::string> folders, names;
  for (const auto& entry : std::filesystem::directory_iterator(NAIAD_SOURCE_DIR "/server/games"))
    if (entry.is_directory()) folders.insert(entry.path().filename());
  for (const auto& [name, game_main] : games()) names.insert(name);
  EXPECT_EQ(names, folders);
}

}  // namespace
}  // namespace naiad
