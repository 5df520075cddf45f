// Parts of a world that only some games use. They are made at first use (World::extras), so that a world
// without them only has a null pointer and tests it a few times in a tick.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/events/Event.h"
#include "engine/world/GameRoomTable.h"
#include "engine/world/Random.h"
#include "engine/world/Resources.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/Settings.h"
#include "engine/world/WorldView.h"

namespace df {

class WorldLog;
class WorldStore;
struct ObjectExtras;
struct WorldState;

/// The shaking of the window (DM.shake): by how many cells the picture is displaced in a tick.
struct ScreenShake {
  int scale_x = 0;  ///< largest displacement to either side, in cells
  int scale_y = 0;
  int ticks = 0;  ///< remaining ticks
  int x = 0;      ///< displacement in this tick, in cells
  int y = 0;

  void step(Random& random) {
    x = y = 0;
    if (ticks <= 0) return;
    --ticks;
    x = random.below(2 * scale_x + 1) - scale_x;
    y = random.below(2 * scale_y + 1) - scale_y;
  }
};

/// The players of a world as the connections of the published engine's NetworkManager. Used by games written
/// as two programs, of which only the server's half runs here (published/NetworkManager.cpp).
struct Connections {
  bool is_server = false;
  /// Maximum number of connected players; further players only watch.
  int limit = 16;
  /// True if the game's server is a player itself (server_plays).
  bool has_host = false;
  /// With has_host, the player that plays as the server and has no socket; 0 for none.
  std::uint32_t host = 0;
  /// Players whose connection the game has closed.
  std::vector<std::uint32_t> closed;
  /// Ids of players; the index is the player's socket. 0: the socket is free.
  std::vector<std::uint32_t> players;

  /// Returns the socket of a player; -1 if they have none.
  int socketOf(std::uint32_t player) const {
    const auto found = std::find(players.begin(), players.end(), player);
    return player == 0 || found == players.end() ? -1 : static_cast<int>(found - players.begin());
  }
  bool isConnected(int socket) const {
    return socket >= 0 && socket < static_cast<int>(players.size()) &&
           players[static_cast<std::size_t>(socket)] != 0;
  }
  int count() const {
    return static_cast<int>(players.size() -
                            static_cast<std::size_t>(std::count(players.begin(), players.end(), 0u)));
  }
};

/// The Objects of a world with running animations.
class Animations {
 public:
  explicit Animations(WorldStore& store) : m_store(store) {}
  Animations(const Animations&) = delete;
  Animations& operator=(const Animations&) = delete;
  /// Resets ObjectExtras::animated of each Object, because Objects may outlive their world.
  ~Animations();

  /// Makes advance() advance the animation of the Object in this slot. A second call has no effect.
  void add(std::uint32_t slot, ObjectExtras& extras);
  void remove(ObjectExtras& extras);
  /// Advances the animations of the active, visible Objects by one tick.
  void advance();

 private:
  struct Entry {
    std::uint32_t slot;
    ObjectExtras* p_extras;  // its `animated` is the index of this entry
  };

  WorldStore& m_store;
  std::vector<Entry> m_entries;
};

/// The part of WorldExtras that World::shutDown() resets.
struct RoundExtras {
  ConfigSettings settings;
  ScreenShake shake;
  std::vector<SoundPlayed> sounds;  ///< played in this tick
  std::uint32_t sounds_lost = 0;
  std::vector<SoundPlayed> playing;  ///< repeating sounds, oldest first
  std::vector<std::string> notes;    ///< lines of this tick for all players to read
  /// If not 0, the host passes on only this player's input.
  std::uint32_t input_player = 0;
  Color background = BLACK;
  Vector view_slack{1.0 / 3, 1.0 / 3};  ///< stored only; has no effect
  bool network_logged = false;          ///< true once the log says that there are no sockets
  Connections connections;
  /// Called with each key, mouse event and leave before the game gets it, and with null before the inputs of
  /// a tick. Returns true if the game must not get the event.
  std::function<bool(const Event*)> input_filter;
  Random random{0xD6A60};
  std::int64_t clock = 0;  ///< last time that a Clock read, in microseconds of game time
};

struct WorldExtras : RoundExtras {
  WorldExtras(WorldStore& store, WorldLog& log, const WorldState& state)
      : resources(log, state), animations(store) {}

  /// Starts a tick.
  void beginTick(int step_count);
  /// Records that a sound or music began, paused or stopped.
  void recordSound(SoundPlayed sound);
  /// Adds a line for all players to read.
  void addNote(std::string line);
  /// True if a sound or music with this label is repeating.
  bool isPlaying(const std::string& label, bool music) const;
  /// Ends a tick, after it was drawn.
  void endTick(bool paused);
  /// Restores the initial state, except animations, scores and rooms. Sprites are kept without their labels,
  /// because Objects may still show them.
  void reset() {
    resources.clear();
    static_cast<RoundExtras&>(*this) = RoundExtras();
  }
  /// Returns the random numbers for visual effects. They are separate, so that effects do not change
  /// WM.randomInt().
  Random& decoration() { return random; }

  static constexpr std::size_t kMaxSounds = 256;  ///< sounds per tick; further ones are only counted
  static constexpr std::size_t kMaxNotes = 4;     ///< lines per tick; further ones are dropped
  static constexpr std::size_t kMaxPlaying = 16;  ///< repeating sounds; a further one replaces the oldest

  Resources resources;
  Animations animations;
  ScoreTables scores;
  GameRoomTable rooms;
};

/// The WorldExtras of a world, made at first use.
class LazyExtras {
 public:
  LazyExtras(WorldStore& store, WorldLog& log, const WorldState& state)
      : m_store(store), m_log(log), m_state(state) {}
  WorldExtras& get();
  /// Like get(), but returns null if get() has not been called yet.
  WorldExtras* find() const { return m_p_extras.get(); }

 private:
  WorldStore& m_store;
  WorldLog& m_log;
  const WorldState& m_state;
  std::unique_ptr<WorldExtras> m_p_extras;
};

}  // namespace df
