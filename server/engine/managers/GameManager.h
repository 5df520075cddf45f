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

/// Version of the published engine whose interface this is.
#define DF_VERSION 4.18

/// The game manager.
#define GM df::GameManager::getInstance()

namespace df {

namespace running {
class Runner;  // Runner.h
}

/// Length of a tick in milliseconds, rounded; the exact length is 1/30 s.
inline constexpr int FRAME_TIME_DEFAULT = 33;

class GameManager : public Manager {
 public:
  /// Returns the only instance; GM is short for it. It acts on the current world.
  static GameManager& getInstance();

  /// Starts all managers, applies df-config.txt (Config.h), and decides whether the world behaves like the
  /// published engine (docs/dragonfly-api.md). Returns 0.
  int startUp() override;
  /// Stops all managers and resets the world (WorldManager::shutDown).
  void shutDown() override;

  /// Runs the game until it is over. If a Runner is set, it decides when ticks begin. A program with its own
  /// main() becomes a server that terminals join (docs/bring-your-game.md), unless df-config.txt has
  /// headless:true. In all other cases ticks run as fast as possible. Does nothing inside a tick.
  void run();
  /// Runs one full tick: step event; joins, leaves, keys and mouse; WM.update(); WM.draw().
  void tick();
  /// Ends run() after the present tick; `false` undoes this. While a player's input is handled, a host may
  /// end the game for that player alone (InputQueue::setGameOverLeaves).
  void setGameOver(bool new_game_over = true);
  bool getGameOver() const;

  /// Returns the number of ticks begun since the world began.
  int getStepCount() const;
  /// Returns the length of a tick, in milliseconds, from df-config.txt or the default.
  int getFrameTime() const;

  /// Sets the Runner, which runs the game loop. Not owned; null for none.
  void setRunner(running::Runner* p_runner);
  /// Restarts the world's random sequence (WM.randomInt).
  void setSeed(std::uint64_t seed);
  /// Lines about the game and its keys, shown on the help screen of clients.
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
