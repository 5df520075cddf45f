// The changes of a tick, as plain data: everything that a host reads of a world.
//
// The engine fills a WorldView at the end of every tick while the world is watched (WorldStore::setWatched),
// and spends nothing on it otherwise. It contains no pointers into the world, so it can be sent to another
// process. The engine does not depend on its readers.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Color.h"
#include "ControlTable.h"
#include "Fixed.h"
#include "Solidness.h"
#include "detail/ObjectKey.h"

namespace naiad {
struct Look;
}

namespace df {

/// State of one object that appeared or changed (moved, turned, resized …) in the tick.
struct ObjectFacts {
  ObjectKey key;
  std::uint64_t order = 0;   ///< place in the creation order of the world, never reused
  FixedVector position;      ///< position at the end of the tick
  FixedVector velocity;      ///< added to the position in the next tick; zero if inactive or just blocked
  FixedVector acceleration;  ///< added to the velocity after moves; zero if inactive, blocked or too large
  FixedBox box;              ///< relative to the position
  Solidness solidness = HARD;
  bool no_soft = false;
  bool shown = true;     ///< active and visible; false: must not be drawn
  bool on_view = false;  ///< a view object: its position is in cells of every view, not in the world
  int altitude = 2;
};

/// One character on the screen, in world coordinates.
struct DrawCommand {
  FixedVector position;
  char32_t ch = U' ';
  Color color = COLOR_DEFAULT;
};

/// A sound or a piece of music that the game began, paused or stopped.
struct SoundPlayed {
  enum What : std::uint8_t { kPlay, kPause, kStop };
  std::string label;  ///< label under which it was loaded
  What what = kPlay;
  bool music = false;        ///< false: a sound
  bool loop = false;         ///< true: repeats
  std::uint32_t player = 0;  ///< player whose input was being handled, a hint for the client; 0: none
  friend bool operator==(const SoundPlayed& a, const SoundPlayed& b) {
    return a.label == b.label && a.what == b.what && a.music == b.music && a.loop == b.loop &&
           a.player == b.player;
  }
  friend bool operator!=(const SoundPlayed& a, const SoundPlayed& b) { return !(a == b); }
};

/// The characters that one object's draw() put on the screen this tick: commands[first, first + count).
struct DrawnObject {
  ObjectKey key;  ///< key.generation 0: drawn outside any object's draw()
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool on_view = false;  ///< view object: its characters keep their cells in every view
};

/// The frames and selector of a drawn object (ObjectLookAccess::setFrames). Its draw() may have drawn others.
struct PublishedLook {
  std::uint32_t drawn = 0;  ///< index in WorldView::drawn
  std::shared_ptr<const naiad::Look> p_look;
};
using ToldLook [[deprecated("say PublishedLook")]] = PublishedLook;

/// A text that only one player sees, at cell (x,y) of their view. If `text` is empty, it was removed.
struct PlayerText {
  std::uint32_t id = 0;
  int x = 0;
  int y = 0;
  Color color = COLOR_DEFAULT;
  std::string text;  ///< UTF-8, drawable characters only
  friend bool operator==(const PlayerText& a, const PlayerText& b) {
    return a.id == b.id && a.x == b.x && a.y == b.y && a.color == b.color && a.text == b.text;
  }
  friend bool operator!=(const PlayerText& a, const PlayerText& b) { return !(a == b); }
};

/// Exact state of an Object that a player steers by declared controls, at the end of the tick.
struct SteeringFacts {
  std::shared_ptr<const ControlTable> p_table;  ///< null: no controls, and no field below is set
  ObjectKey object;  ///< generation 0: no Object is steered, and only `state` is set below
  ControlState state;
  FixedVector position;
  FixedVector velocity;  ///< next tick's attempted move, even if the last move was blocked
  FixedVector acceleration;
};

/// A player as seen from outside the world.
struct PlayerFacts {
  std::uint32_t id = 0;
  std::string name;
  Color color = COLOR_DEFAULT;
  int score = 0;
  ObjectKey followed;             ///< Object that the view follows; generation 0: none
  FixedVector view_corner;        ///< upper left corner of the view, in world coordinates, with the shake
  std::vector<PlayerText> texts;  ///< non-empty ones, by id
  SteeringFacts steering;
};

struct WorldView {
  std::uint32_t tick = 0;  ///< number of ticks since the world began
  FixedBox boundary;       ///< boundary of the world
  int view_width = 80;     ///< size of every view, in cells
  int view_height = 24;
  std::vector<ObjectFacts> changed;   ///< Objects that appeared or changed, in creation order
  std::vector<ObjectKey> vanished;    ///< deleted or removed Objects; not in `changed` of this tick
  std::vector<DrawnObject> drawn;     ///< drawn Objects in drawing order; they may have vanished since
  std::vector<DrawCommand> commands;  ///< drawn characters, in drawing order
  std::vector<PublishedLook> looks;   ///< looks of those Objects in `drawn` that have frames
  std::vector<PlayerFacts> players;   ///< all players, by id
  FixedVector corner;                 ///< corner of the world's own view, in which view objects were drawn
  std::vector<SoundPlayed> sounds;    ///< sounds in the order they were played
  std::uint32_t sounds_lost = 0;      ///< number of further sounds of this tick, which were not recorded
  std::vector<SoundPlayed> playing;   ///< repeating sounds, oldest first
  std::vector<std::string> notes;     ///< lines that the engine shows to all players
  Color background = BLACK;           ///< background colour of the window
  int shake_x = 0;                    ///< cells by which views are displaced in this tick
  int shake_y = 0;
};

}  // namespace df
