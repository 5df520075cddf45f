// Plays a game without terminal, network and clock, for tests, which press keys in certain ticks and check
// the picture.
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
// game's own main() runs, in a world of its own, up to GM.run(); then the test controls the game by calls of
// tick(). Two runs with one seed and equal keys are equal, tick for tick.
//
// While a GameTest exists, its world is the current world of this thread, so that WM, GM and the game's own
// classes can be used as in the game. If several exist, the world of the newest is the current one, and the
// newest must be destroyed first. A tick is 1/30 s of game time, but runs as fast as possible. Cell (0,0) is
// the upper left one of the player's view; x grows to the right, y downward.
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
  /// Starts the game in this module, which dragonfly_game(NAME MODULE …) makes. Each GameTest loads the
  /// module anew, so that global and static variables are as at the start of a program. Sprites and sounds
  /// are found where dfserver finds them. Throws std::runtime_error if the module cannot be loaded, has no
  /// main(), or if its main() ends without having called GM.run().
  explicit GameTest(const std::string& module, std::uint64_t seed = 1);
  /// Starts the game whose main() was compiled into this program under another name (-Dmain=my_main). Its
  /// static variables keep their values from one GameTest to the next. Throws like the constructor above.
  explicit GameTest(int (*p_main)(), std::uint64_t seed = 1);
  /// Ends the game as a server would: GM.run() returns, and main() runs to its end.
  ~GameTest();
  GameTest(const GameTest&) = delete;
  GameTest& operator=(const GameTest&) = delete;

  // Players.

  /// Adds a player; one tick passes. Returns the player's id: 1, 2, …; ids are not reused. An empty name
  /// becomes "player N" for the Nth player in the game at that time, and the colour also depends only on N.
  std::uint32_t join(const std::string& name = "");
  /// Removes a player; one tick passes.
  void leave(std::uint32_t player = 0);

  // Time.

  /// Runs `count` ticks, or fewer if the game ends earlier. If main() calls GM.run() again, for example after
  /// a title, the game continues. Returns the number of ticks that passed.
  int tick(int count = 1);
  /// Runs ticks until `holds()` is true, at most `most` ticks. Returns the last result of `holds()`.
  bool tickUntil(const std::function<bool()>& holds, int most = 300);
  /// Returns the number of ticks that have passed.
  int getTicks() const;
  /// True if the game's last GM.run() has returned.
  bool isOver() const;

  // Scores (HighScores.h). For rows of the present game, a test uses df::HighScores.

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
  /// Press or release a key; no tick passes. Use these for keys of several players in one tick.
  void down(Keyboard::Key key, std::uint32_t player = 0);
  void up(Keyboard::Key key, std::uint32_t player = 0);
  /// Clicks a mouse button at a cell of the player's view; one tick passes. Ignores clicks outside.
  void click(int x, int y, Mouse::Button button = Mouse::LEFT, std::uint32_t player = 0);
  /// Moves the pointer to a cell; one tick passes.
  void moveMouse(int x, int y, std::uint32_t player = 0);

  // The picture that a player sees after the last tick. Before the first join, it is the world's own view.

  /// Returns the rows of the picture, each without blanks at its end but with a newline.
  std::string picture(std::uint32_t player = 0) const;
  /// Like picture(), with colours.
  Canvas canvas(std::uint32_t player = 0) const;
  /// True if a row of the picture contains this text.
  bool shows(const std::string& text, std::uint32_t player = 0) const;
  /// Returns the number of times that the picture contains this text, without overlaps; 0 for an empty text.
  int count(const std::string& text, std::uint32_t player = 0) const;
  /// Return the character in a cell, and its colour; outside the view, a blank.
  char32_t at(int x, int y, std::uint32_t player = 0) const;
  Color colorAt(int x, int y, std::uint32_t player = 0) const;

  // The world and its events.

  /// Returns the number of active Objects of this type (Object::setType).
  int objects(const std::string& type) const;
  /// Returns the first active Object of this type in creation order; null if there is none.
  Object* find(const std::string& type) const;
  /// Returns the player's points (Player::setScore); 0 if the player is not in the game.
  int score(std::uint32_t player = 0) const;
  /// Returns how often the sound or music with this label was played since the start.
  int played(const std::string& label) const;
  /// Returns the lines that the game has written to its log so far.
  const std::vector<std::string>& log() const;

  // Expectations.

  /// Checks that `holds` is true. If not, prints file, line and `what` to stderr, with the picture and the
  /// last lines of the log, and report() returns 1. Returns `holds`.
  bool expect(bool holds, const std::string& what, const char* p_file = __builtin_FILE(),
              int line = __builtin_LINE());
  /// Checks that the player's picture shows this text.
  bool expectShows(const std::string& text, std::uint32_t player = 0, const char* p_file = __builtin_FILE(),
                   int line = __builtin_LINE());
  /// Prints how many checks of all GameTests of this program passed and failed. Returns 0, or 1 if one failed
  /// or there was none: the result for a test's main() to return.
  static int report();

 private:
  class Game;
  std::unique_ptr<Game> m_p_game;
};

}  // namespace df
