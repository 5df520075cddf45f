// Runs the game loop of the current world (book, Listing 4.17).
//
//     int main() {
//       if (GM.startUp()) return 1;
//       new Hero;
//       GM.run();
//       GM.shutDown();
//     }
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Config.h"
#include "Manager.h"
#include "StandardHeaders.h"

/// The published version that has this interface.
#define DF_VERSION 4.18

/// The game manager.
#define GM df::GameManager::getInstance()

namespace df {

namespace running {
class Runner;  // Runner.h
}

/// Length of a tick, in milliseconds, rounded; exactly it is 1/30 s.
inline constexpr int FRAME_TIME_DEFAULT = 33;

class GameManager : public Manager {
 public:
  /// The one there is; GM is short for it. It acts on the current world.
  static GameManager& getInstance();

  /// Start all managers, take on what df-config.txt says (Config.h), and decide whether to be compatible
  /// (docs/dragonfly-api.md). Return 0.
  int startUp() override;
  /// Stop all managers and set the world back (WorldManager::shutDown).
  void shutDown() override;

  /// Run until the game is over: through the installed Runner, which may wait for clocks and players; in a
  /// program with a main() of its own as a server that terminals join (docs/bring-your-game.md), unless
  /// df-config.txt says headless:true; else tick after tick as fast as they go. Nothing happens inside a
  /// tick.
  void run();
  /// One full tick: step event; joins, leaves, keys and mouse; WM.update(); WM.draw().
  void tick();
  /// End run() after the present tick; `false` takes it back. While a player's input is handled, a host may
  /// take it as the wish of that player alone (InputQueue::setGameOverLeaves).
  void setGameOver(bool new_game_over = true);
  bool getGameOver() const;

  /// Ticks begun since the world began.
  int getStepCount() const;
  /// Length of a tick, in milliseconds: what df-config.txt says, or the default.
  int getFrameTime() const;

  /// Runs the loop; not owned; null for none.
  void setRunner(running::Runner* p_runner);
  /// Restart the world's random sequence (WM.randomInt).
  void setSeed(std::uint64_t seed);
  /// A few lines about the game and its keys, for the help screen of the clients.
  void setHelp(std::vector<std::string> lines);
  const std::vector<std::string>& getHelp() const;

 private:
  GameManager();
};

#if defined(DF_COMPAT)
namespace running {
bool declareCompat(bool compat);  // Runner.h
inline const bool compat_declared = declareCompat(DF_COMPAT);
}  // namespace running
#endif

}  // namespace df
