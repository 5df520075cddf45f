// The game: each player gets a ship.
#include "GameManager.h"
#include "Ship.h"

int main() {
  if (GM.startUp() != 0) return 1;
  GM.setHelp({"@NAME@: every player is an @", "", "arrows   fly"});
  new df::JoinSpawner<Ship>;  // makes a Ship for each player that joins
  GM.run();
  GM.shutDown();
  return 0;
}
