// Saucer Shoot for many players: the whole game of the Dragonfly tutorial, for one to eight pilots or more.
//
// Start reading here, then continue with Round and Hero. dfserver loads this game, runs main() and shows the
// game to the players; it contains no network code.
#include "GameManager.h"
#include "Round.h"
#include "Scoreboard.h"
#include "Spawner.h"
#include "Sprites.h"
#include "Star.h"

int main() {
  if (GM.startUp()) return 1;
  if (loadSprites()) return 1;
  GM.setHelp({
      "Saucer Shoot: shoot the saucers, do not touch them.",
      "",
      "arrows, WASD   fly",
      "space          shoot ahead; the gun aims a little by itself",
      "mouse button   shoot where you click",
      "N, Enter       nuke: clears the sky, earns nothing",
      "",
      "Three ships each; the round is over when the last one is lost.",
      "20 hits earn a nuke. The more pilots have hit something in the",
      "last three seconds, the more a saucer is worth: up to four times.",
  });

  // Objects are made with new. The world deletes them.
  for (int i = 0; i < 30; ++i) new Star;
  new Spawner;
  new Round;
  new Scoreboard;

  GM.run();  // returns when the server ends
  GM.shutDown();
  return 0;
}
