// Plays a game without terminal, network and clock, for tests: press keys at ticks, look at the picture,
// assert.
//
//   #include "GameTest.h"
//
//   int main() {
//     df::GameTest game(DRAGONFLY_GAME, 7);     // 7: the seed of all that is random
//     game.join("ann");
//     game.hold(df::Keyboard::RIGHTARROW, 10);  // for 10 ticks
//     game.press(df::Keyboard::SPACE);
//     game.tick(20);
//     game.expectShows("points 10");
//     return game.report();                     // 0 if all that was expected came true
//   }
//
// dragonfly_test() in CMake builds such a program and defines DRAGONFLY_GAME (docs/testing-your-game.md). The
// game's own main() runs, in a world of its own, up to GM.run(); there the test takes over, and calls tick().
// The same seed and keys give the same game, tick for tick.
//
// While a GameTest lives, its world is the current one of this thread, so that WM, GM and the game's own
// classes can be used as in the game. If several live at once, the newest is the current one, and must be
// destroyed first. A tick is 1/30 s of the game, and takes as long as it computes. Cells are counted from the
// upper left one of the player's view, (0,0); x goes right, y down.
//
// Player 0 is always the player that joined first.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "Canvas.h"
#include "Color.h"
#include "GameRooms.h"
#include "Keyboard.h"

namespace df {

class Object;

class GameTest {
 public:
  /// Starts the game of this module, which dragonfly_game(NAME MODULE …) makes. Each GameTest loads it anew,
  /// so that its global and static variables are as at the start of a program; sprites and sounds are found
  /// where dfserver finds them. Throws std::runtime_error if it cannot be loaded, has no main(), or if its
  /// main() ends without having called GM.run().
  explicit GameTest(const std::string& module, std::uint64_t seed = 1);
  /// Starts the game whose main() was compiled into this program under another name (-Dmain=my_main). Its
  /// static variables stay from one GameTest to the next. Throws like the constructor above.
  explicit GameTest(int (*p_main)(), std::uint64_t seed = 1);
  /// Ends the game as a server would: GM.run() returns, and main() runs to its end.
  ~GameTest();
  GameTest(const GameTest&) = delete;
  GameTest& operator=(const GameTest&) = delete;

  // Players.

  /// Adds a player; one tick passes. Returns the player's id: 1, 2, …, each number once. An empty name
  /// becomes "player 1" and so on; colours are given in turn.
  std::uint32_t join(const std::string& name = "");
  /// Removes a player; one tick passes.
  void leave(std::uint32_t player = 0);

  // Time.

  /// Runs `count` ticks, or fewer if the game is over before. If main() calls GM.run() again, for example
  /// after a title, the game continues. Returns how many passed.
  int tick(int count = 1);
  /// Runs ticks until `holds()`, at most `most`. Returns whether it holds.
  bool tickUntil(const std::function<bool()>& holds, int most = 300);
  /// Returns the number of ticks that have passed.
  int getTicks() const;
  /// True if the game's last GM.run() has returned.
  bool isOver() const;

  // Scores (HighScores.h). A test adds and reads others through df::HighScores.

  /// Adds a row to a table, as if a server had stored it. Call it before the first tick, for games that show
  /// the best rows from the start.
  void addStoredScore(const std::string& table, const std::string& name, std::int64_t points);
  [[deprecated("say addStoredScore")]] void keepScore(const std::string& table, const std::string& name,
                                                      std::int64_t points) {
    addStoredScore(table, name, points);
  }

  // Rooms (GameRooms.h).

  /// Adds a room to the server, or updates it.
  void setRoom(const GameRoom& room);
  [[deprecated("say setRoom")]] void keepRoom(const GameRoom& room) { setRoom(room); }
  /// Returns the room to which the game sent this player in the last tick, or "". The player stays here.
  std::string sentTo(std::uint32_t player = 0) const;

  // Keys and mouse. They are handled in the next tick, in the order of the calls.

  /// Presses and releases a key; one tick passes.
  void press(Keyboard::Key key, std::uint32_t player = 0);
  /// Holds a key down while `ticks` ticks pass, at least one, then releases it.
  void hold(Keyboard::Key key, int ticks, std::uint32_t player = 0);
  /// Presses or releases a key; no tick passes. For keys of several players in one tick.
  void down(Keyboard::Key key, std::uint32_t player = 0);
  void up(Keyboard::Key key, std::uint32_t player = 0);
  /// Presses a mouse button at a cell of the player's view, nothing outside of it; one tick passes.
  void click(int x, int y, Mouse::Button button = Mouse::LEFT, std::uint32_t player = 0);
  /// Moves the pointer to a cell; one tick passes.
  void moveMouse(int x, int y, std::uint32_t player = 0);

  // The picture of a player after the last tick. Before the first join: the world's own view.

  /// Returns the rows, each with a newline, without blanks at their ends.
  std::string picture(std::uint32_t player = 0) const;
  /// Like picture(), with colours.
  Canvas canvas(std::uint32_t player = 0) const;
  /// True if this text is in a row of the picture.
  bool shows(const std::string& text, std::uint32_t player = 0) const;
  /// Returns how often it is there, without overlaps; 0 for an empty text.
  int count(const std::string& text, std::uint32_t player = 0) const;
  /// Returns the character of a cell, and its colour; blank outside of the view.
  char32_t at(int x, int y, std::uint32_t player = 0) const;
  Color colorAt(int x, int y, std::uint32_t player = 0) const;

  // The world and its events.

  /// Returns the number of active Objects of this type (Object::setType).
  int objects(const std::string& type) const;
  /// Returns the first of them in creation order; null if not found.
  Object* find(const std::string& type) const;
  /// Returns the points (Player::setScore); 0 for a player that is not there.
  int score(std::uint32_t player = 0) const;
  /// Returns how often a sound or a piece of music of this label was played since the start.
  int played(const std::string& label) const;
  /// Returns the lines of dragonfly.log so far.
  const std::vector<std::string>& log() const;

  // Expectations.

  /// Records that this must be true. If it is not, prints file, line and `what` to stderr, with the picture
  /// and the last lines of the log. Returns `holds`.
  bool expect(bool holds, const std::string& what, const char* p_file = __builtin_FILE(),
              int line = __builtin_LINE());
  /// Expects that the player sees this text.
  bool expectShows(const std::string& text, std::uint32_t player = 0, const char* p_file = __builtin_FILE(),
                   int line = __builtin_LINE());
  /// Prints how many expectations of all GameTests of this program held. Returns 0, or 1 if one did not or
  /// there was none: the result of a test's main().
  static int report();

 private:
  class Game;
  std::unique_ptr<Game> m_p_game;
};

}  // namespace df
