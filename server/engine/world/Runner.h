// The seams through which a host runs a game's loop.
//
// A program that loads games (dfserver) gives the world a Runner before it calls the game's main(). A game
// that is a program itself sets none: GM.startUp() and GM.run() then call the Program that the library's
// hosting part has set when it was loaded. Without either, GM.run() steps headless.
#pragma once

namespace df {

class World;

// In a namespace of its own, so that a game that says `using namespace df` may have a Runner itself.
namespace running {

class Runner {
 public:
  virtual ~Runner() = default;
  /// Call `world.tick()` until the game is over (World::isGameOver) or the runner has a reason to stop.
  virtual void run(World& world) = 0;
};

/// Runs the default world of a process that has no Runner. Worlds that are made by hand never use it.
class Program : public Runner {
 public:
  /// GM.startUp() is about to return: settings are read, and nothing of the game exists yet.
  virtual void startUp(World& world) = 0;
};

/// Not owned; it lives as long as the process. Null: none. To be called before the game's main() begins, or
/// by it before GM.startUp().
void setProgram(Program* p_program);
Program* program();

/// The game was built with the compiler's -DDF_COMPAT=0 or 1 (GameManager.h calls it). Return `compat`.
bool declareCompat(bool compat);

/// World::setCompat() as far as it is decided before df-config.txt is read: by the build, else on in a
/// Program, else as it is.
bool beginCompat(bool compat, bool in_program);
/// The environment decides last: DF_COMPAT=0 or 1.
bool endCompat(bool compat);

}  // namespace running

using running::Runner;

}  // namespace df
