// The seam through which somebody else may run a game's loop: GM.run() hands its world to the installed
// Runner. The host implements one (sockets, a clock, players); without any, GM.run() steps headless.
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

}  // namespace running

using running::Runner;

}  // namespace df
