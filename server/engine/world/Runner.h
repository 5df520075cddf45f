// Interfaces by which a host runs a game's loop.
//
// A program that loads games (dfserver) gives the world a Runner before it calls the game's main(). A game
// that is a program itself sets none: GM.startUp() and GM.run() then call the Program that the library's
// hosting part has set when it was loaded. Without either, GM.run() runs ticks as fast as possible.
#pragma once

namespace df {

class World;

// The namespace allows a game with `using namespace df` to have classes of these names.
namespace running {

class Runner {
 public:
  virtual ~Runner() = default;
  /// Calls `world.tick()` until the game is over (World::isGameOver) or the runner has a reason to stop.
  virtual void run(World& world) = 0;
};

/// Runs the default world of a process that has no Runner. Worlds made by hand never use it.
class Program : public Runner {
 public:
  /// Called at the end of GM.startUp(), when settings have been read and the game has made no Objects yet.
  virtual void startUp(World& world) = 0;
};

/// Sets the Program; null: none. Not owned; it must exist as long as the process. Call this before the game's
/// main() begins, or from main() before GM.startUp().
void setProgram(Program* p_program);
Program* program();

/// Records that the game was built with -DDF_COMPAT=0 or 1. GameManager.h calls it. Returns `compat`.
bool declareCompat(bool compat);

/// Returns the compat setting before df-config.txt is read: the one given to declareCompat(), if any;
/// otherwise true if `in_program`, else `compat`.
bool beginCompat(bool compat, bool in_program);
/// Returns the final compat setting: the environment's DF_COMPAT, if 0, 1, false or true, else `compat`.
bool endCompat(bool compat);

}  // namespace running

using running::Runner;

}  // namespace df
