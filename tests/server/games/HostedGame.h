// Runs a game's main() in a world of its own, as dfserver does, and lets a test play it.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "GameManager.h"
#include "Player.h"
#include "Runner.h"
#include "World.h"
#include "WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace naiad {

/// Calls `play` at the point where GM.run() would wait for players.
class TestRunner : public df::Runner {
 public:
  explicit TestRunner(std::function<void(df::World&)> play) : m_play(std::move(play)) {}
  void run(df::World& world) override { m_play(world); }

 private:
  std::function<void(df::World&)> m_play;
};

/// Runs the game with this seed until its shutDown(). `folder` is the folder in server/games with the files
/// that it loads.
inline void hostGame(int (*game_main)(), std::uint64_t seed, std::function<void(df::World&)> play,
                     const std::string& folder = {}) {
  df::World world;
  const df::World::Scope scope(world);
  world.log().setSink([](const std::string&) {});
  world.setSeed(seed);
  if (!folder.empty())
    world.extras().resources.addFolder(std::string(NAIAD_SOURCE_DIR) + "/server/games/" + folder);
  TestRunner runner(std::move(play));
  world.setRunner(&runner);
  game_main();
}

/// True if the screen of this player shows this text.
inline bool shows(const df::World& world, std::uint32_t player, const std::string& text) {
  return world.picture().renderPlayer(player).text().find(text) != std::string::npos;
}

inline void tick(df::World& world, int count) {
  for (int i = 0; i < count; ++i) world.tick();
}

/// Adds a player "ann" and runs this many ticks. Returns the player's id.
inline std::uint32_t joinAnn(df::World& world, int ticks = 1) {
  const std::uint32_t ann = world.input().join("ann", df::RED);
  tick(world, ticks);
  return ann;
}

/// Presses and releases a key before the next tick.
inline void tap(df::World& world, std::uint32_t player, df::Keyboard::Key key) {
  world.input().key(player, key, df::KEY_PRESSED);
  world.input().key(player, key, df::KEY_RELEASED);
}

/// True if an Object of this type is in the box.
inline bool isThere(df::Box box, const char* type) {
  const df::ObjectList there = WM.objectsInBox(box);
  for (int i = 0; i < there.getCount(); ++i)
    if (there[i]->getType() == type) return true;
  return false;
}

/// The keys that a bot holds down, sent to the world as a client would send them.
class Fingers {
 public:
  Fingers(df::World& world, std::uint32_t player) : m_world(world), m_player(player) {}

  /// Holds these keys down and releases all others.
  void hold(const std::set<df::Keyboard::Key>& keys) {
    for (const df::Keyboard::Key key : m_down) {
      if (!keys.contains(key)) m_world.input().key(m_player, key, df::KEY_RELEASED);
    }
    for (const df::Keyboard::Key key : keys)
      m_world.input().key(m_player, key, m_down.contains(key) ? df::KEY_DOWN : df::KEY_PRESSED);
    m_down = keys;
  }

 private:
  df::World& m_world;
  std::uint32_t m_player;
  std::set<df::Keyboard::Key> m_down;
};

}  // namespace naiad
