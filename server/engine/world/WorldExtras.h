// What a world has only if its game uses it. Made at first use (World::extras), so that a world without it
// costs a null pointer and one test in a tick.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/events/Event.h"
#include "engine/world/Random.h"
#include "engine/world/Resources.h"
#include "engine/world/RoomTable.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/Settings.h"
#include "engine/world/WorldView.h"

namespace df {

class WorldLog;
class WorldStore;
struct ObjectExtras;
struct WorldState;

/// The window shakes (DM.shake): by how many cells the picture is off its place in a tick.
struct Shaking {
  int scale_x = 0;  ///< at most so many cells to either side
  int scale_y = 0;
  int ticks = 0;  ///< that are left
  int x = 0;      ///< in this tick
  int y = 0;

  void step(Random& random) {
    x = y = 0;
    if (ticks <= 0) return;
    --ticks;
    x = random.below(2 * scale_x + 1) - scale_x;
    y = random.below(2 * scale_y + 1) - scale_y;
  }
};

/// The players of a world as the connections of the published engine's NetworkManager: for games that were
/// written as two programs, of which the server's half is played here (published/NetworkManager.cpp).
struct Connections {
  bool is_server = false;
  /// At most so many players are connected; the others watch.
  int limit = 16;
  /// Is the game's server a player itself (server_plays)?
  bool has_host = false;
  /// The player that sits at the server then; 0 for none.
  std::uint32_t host = 0;
  /// Players whose connection the game has closed.
  std::vector<std::uint32_t> closed;
  /// By socket, which is an index here: the player, or 0 for none.
  std::vector<std::uint32_t> players;

  /// The socket of a player; -1 for none.
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
  /// Objects may outlive their world.
  ~Animations();

  /// Runs the animation of the Object in this slot. Adding it twice is once.
  void add(std::uint32_t slot, ObjectExtras& extras);
  void remove(ObjectExtras& extras);
  /// One tick has passed.
  void advance();

 private:
  struct Entry {
    std::uint32_t slot;
    ObjectExtras* p_extras;  // it stores its place here (ObjectExtras::animated)
  };

  WorldStore& m_store;
  std::vector<Entry> m_entries;
};

/// The part that World::shutDown() sets back.
struct RoundExtras {
  ConfigSettings settings;
  Shaking shake;
  std::vector<SoundPlayed> sounds;  ///< of this tick
  std::uint32_t sounds_lost = 0;
  std::vector<SoundPlayed> playing;  ///< again and again
  std::vector<std::string> notes;    ///< of this tick
  /// The only player whose input the host hands in; 0: all players'.
  std::uint32_t heard_player = 0;
  Color background = BLACK;
  Vector view_slack{1.0 / 3, 1.0 / 3};  ///< as asked for; it has no effect
  bool network_said = false;            ///< that there are no sockets
  Connections connections;
  /// Gets each key, mouse event and leave before the game does, and null before the inputs of a tick. Returns
  /// true if the game is not to get it.
  std::function<bool(const Event*)> input_filter;
  Random random{0xD6A60};
  std::int64_t clock = 0;  ///< what a Clock read last, in microseconds of game time
};

struct WorldExtras : RoundExtras {
  WorldExtras(WorldStore& store, WorldLog& log, const WorldState& state)
      : resources(log, state), animations(store) {}

  /// The world has begun this tick.
  void beginTick(int step_count);
  /// A sound or music began, paused or stopped.
  void noteSound(SoundPlayed sound);
  /// A line for all players to read.
  void addNote(std::string line);
  /// Does it go on again and again?
  bool isPlaying(const std::string& label, bool music) const;
  /// The tick is over, drawn and all.
  void endTick(bool paused);
  /// As at the beginning, but for scores and rooms. Sprites live on as long as the world, for Objects may
  /// still show them.
  void reset() {
    resources.clear();
    static_cast<RoundExtras&>(*this) = RoundExtras();
  }
  /// Numbers for what is only seen, so that WM.randomInt() gives the same with it and without.
  Random& decoration() { return random; }

  static constexpr std::size_t kMaxSounds = 256;  ///< in a tick; more are only counted
  static constexpr std::size_t kMaxNotes = 4;     ///< in a tick
  static constexpr std::size_t kMaxPlaying = 16;  ///< repeating; the oldest makes room

  Resources resources;
  Animations animations;
  ScoreTables scores;
  RoomTable rooms;
};

/// The WorldExtras of a world, made at first use.
class LazyExtras {
 public:
  LazyExtras(WorldStore& store, WorldLog& log, const WorldState& state)
      : m_store(store), m_log(log), m_state(state) {}
  WorldExtras& get();
  /// Null before the first get().
  WorldExtras* find() const { return m_p_extras.get(); }

 private:
  WorldStore& m_store;
  WorldLog& m_log;
  const WorldState& m_state;
  std::unique_ptr<WorldExtras> m_p_extras;
};

}  // namespace df
