// Lander: bring a ship down gently. Gravity, jets and impacts are the engine's; start reading at Ship.
#include "EventPlayer.h"
#include "GameManager.h"
#include "Ground.h"
#include "PhysicsManager.h"
#include "Seconds.h"
#include "Ship.h"
#include "WorldManager.h"

namespace {

/// Gives everybody who comes a ship.
class Port : public df::Object {
 public:
  Port() {
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e))
      new Ship(*WM.getPlayer(p_join->getPlayer()));
    return 1;
  }
};

}  // namespace

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
  PM.setGravity(df::perSecondSquared(df::Vector(0, 2)));  // the moon's
  makeLandscape();
  new Port;
  GM.run();
  GM.shutDown();
  return 0;
}
