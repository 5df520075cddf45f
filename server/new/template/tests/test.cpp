// Plays the game without a terminal: docs/testing-your-game.md.
#include "GameTest.h"
#include "Object.h"

int main() {
  df::GameTest game(DRAGONFLY_GAME, 1);
  game.join("ann");
  game.expect(game.objects("Ship") == 1, "each player has a ship");

  const float before = game.find("Ship")->getPosition().getX();
  game.hold(df::Keyboard::RIGHTARROW, 5);
  game.expect(game.find("Ship")->getPosition().getX() > before, "the right arrow flies to the right");

  game.join("bob");
  game.expect(game.objects("Ship") == 2, "the second player has a ship, too");
  return game.report();
}
