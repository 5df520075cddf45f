// Lander: bring a ship down gently. The engine computes gravity, jets and impacts; start reading at Ship.
#include "GameManager.h"
#include "Ground.h"
#include "PhysicsManager.h"
#include "Seconds.h"
#include "Ship.h"

int main() {
  if (GM.startUp()) return 1;
  GM.setHelp({
      "Lander: set your ship down on a green pad, gently.",
      "",
      "up, W, space   main engine",
      "left, right    side jets (A, D)",
      "",
      "The legs bear 2.2 cells a second. What is left in the tank counts",
      "as well; so does bumping into others, who will not thank you.",
  });
  PM.setGravity(df::perSecondSquared(df::Vector(0, 2)));  // gravity of the moon
  makeLandscape();
  new df::JoinSpawner<Ship>;
  GM.run();
  GM.shutDown();
  return 0;
}
