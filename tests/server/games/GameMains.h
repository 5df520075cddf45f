// The main() functions of the shipped games, renamed so that all of them can be in one program.
#pragma once

#include <map>
#include <string>

int breakout_main();
int bullethell_main();
int chase_main();
int hello_main();
int lander_main();
int lobby_main();
int maze_main();
int platformer_main();
int sandbox_main();
int saucershoot_main();
int tron_main();

namespace naiad {

/// Returns the main() functions by the name of their game.
inline const std::map<std::string, int (*)()>& gameMains() {
  static const std::map<std::string, int (*)()> s_mains = {
      {"breakout", breakout_main}, {"bullethell", bullethell_main},
      {"chase", chase_main},       {"hello", hello_main},
      {"lander", lander_main},     {"lobby", lobby_main},
      {"maze", maze_main},         {"platformer", platformer_main},
      {"sandbox", sandbox_main},   {"saucershoot", saucershoot_main},
      {"tron", tron_main}};
  return s_mains;
}

}  // namespace naiad
