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
// The same seed and the same keys give the same game, tick for tick.
//
// While a GameTest lives its world is the current one of this thread, so that WM, GM and the game's own
// classes can be asked as the game would. Of several that live at once the youngest is the current one, and
// is destroyed first. Ticks are 1/30 s of the game, and take as long as they compute. Cells are counted from
// the upper left one of the player's view, (0,0); x goes right, y down.
//
// Everywhere `player` 0 is the player that joined first.
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
  /// Start the game of this module, which dragonfly_game(NAME MODULE …) makes. Each GameTest loads it anew,
  /// so that its global and static variables are as at the start of a program; sprites and sounds are found
  /// where dfserver finds them. Throws std::runtime_error, with a sentence, if it cannot be loaded, has no
  /// main(), or if its main() ends without having called GM.run().
  explicit GameTest(const std::string& module, std::uint64_t seed = 1);
  /// Start the game whose main() was compiled into this program under another name (-Dmain=my_main). Its
  /// static variables stay from one GameTest to the next. Throws as above.
  explicit GameTest(int (*p_main)(), std::uint64_t seed = 1);
  /// Ends the game as a server would: GM.run() returns, and main() runs to its end.
  ~GameTest();
  GameTest(const GameTest&) = delete;
  GameTest& operator=(const GameTest&) = delete;

  // Players.

  /// A player comes; one tick passes. Return the player's id: 1, 2, …, each number once. An empty name
  /// becomes "player 1" and so on; colours are given in turn.
  std::uint32_t join(const std::string& name = "");
  /// A player goes; one tick passes.
  void leave(std::uint32_t player = 0);

  // Time.

  /// Let `count` ticks pass, or fewer if the game is over before. A main() that calls GM.run() again, after a
  /// title, say, goes on. Return how many passed.
  int tick(int count = 1);
  /// Let ticks pass until `holds()`, but `most` at most. Return whether it holds.
  bool tickUntil(const std::function<bool()>& holds, int most = 300);
  /// Ticks that have passed in all.
  int getTicks() const;
  /// Has the game's last GM.run() returned?
  bool isOver() const;

  // Scores (HighScores.h). A test adds and reads others through df::HighScores.

  /// A row of a table, as if a server had kept it: before the first tick, for games that show the best ones
  /// from the start.
  void keepScore(const std::string& table, const std::string& name, std::int64_t points);

  // Rooms (GameRooms.h).

  /// The server has this room, or it is so from now on.
  void keepRoom(const GameRoom& room);
  /// Where the game has sent this player in the last tick; empty: nowhere. It stays in this world.
  std::string sentTo(std::uint32_t player = 0) const;

  // Keys and mouse. They are handled in the next tick, in the order of the calls.

  /// Down and up again; one tick passes.
  void press(Keyboard::Key key, std::uint32_t player = 0);
  /// Hold it down while `ticks` ticks pass, at least one, then let it go.
  void hold(Keyboard::Key key, int ticks, std::uint32_t player = 0);
  /// The key goes down, or up; no tick passes. For keys of several players in one tick.
  void down(Keyboard::Key key, std::uint32_t player = 0);
  void up(Keyboard::Key key, std::uint32_t player = 0);
  /// A mouse button goes down at a cell of the player's view; one tick passes. Outside of the view: nothing.
  void click(int x, int y, Mouse::Button button = Mouse::LEFT, std::uint32_t player = 0);
  /// The pointer moves to a cell; one tick passes.
  void moveMouse(int x, int y, std::uint32_t player = 0);

  // What a player sees after the last tick. Before anybody joined: the world's own view.

  /// The rows, each with a newline, without blanks at their ends.
  std::string picture(std::uint32_t player = 0) const;
  /// The same with colours.
  Canvas canvas(std::uint32_t player = 0) const;
  /// Is this text in a row of the picture?
  bool shows(const std::string& text, std::uint32_t player = 0) const;
  /// How often it is there, without overlaps. 0 for an empty text.
  int count(const std::string& text, std::uint32_t player = 0) const;
  /// The character of a cell, and its colour; blank outside of the view.
  char32_t at(int x, int y, std::uint32_t player = 0) const;
  Color colorAt(int x, int y, std::uint32_t player = 0) const;

  // What is in the world, and what happened.

  /// Active Objects of this type (Object::setType).
  int objects(const std::string& type) const;
  /// The first of them in creation order; null if there is none.
  Object* find(const std::string& type) const;
  /// Points (Player::setScore); 0 for a player who is not there.
  int score(std::uint32_t player = 0) const;
  /// How often a sound or a piece of music of this label was played since the start.
  int played(const std::string& label) const;
  /// The lines of dragonfly.log so far.
  const std::vector<std::string>& log() const;

  // Expectations.

  /// Note that this must be true. If it is not, file, line and `what` are printed on stderr, with the picture
  /// and the last lines of the log. Return `holds`.
  bool expect(bool holds, const std::string& what, const char* p_file = __builtin_FILE(),
              int line = __builtin_LINE());
  /// Expect that the player sees this text.
  bool expectShows(const std::string& text, std::uint32_t player = 0, const char* p_file = __builtin_FILE(),
                   int line = __builtin_LINE());
  /// Print how many expectations of all GameTests of this program came true. Return 0, or 1 if one did not,
  /// or if there was none: what main() of a test returns.
  static int report();

 private:
  class Game;
  std::unique_ptr<Game> m_p_game;
};

}  // namespace df
