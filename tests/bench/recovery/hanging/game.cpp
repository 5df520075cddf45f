// A game that hangs at the key H, which players with random keys do not press.
#include "EventKeyboard.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Object.h"

using namespace df;

namespace {

volatile bool g_hangs = true;

class Walker : public Object {
 public:
  Walker() {
    setType("Walker");
    setPosition(Vector(40, 12));
    setVelocity(Vector(0.1, 0));
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == STEP_EVENT) {
      if (getPosition().getX() > 70 || getPosition().getX() < 10)
        setVelocity(Vector(-getVelocity().getX(), 0));
      return 1;
    }
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    while (static_cast<const EventKeyboard*>(p_e)->getKey() == Keyboard::H && g_hangs) {
    }
    return 1;
  }
};

}  // namespace

int main() {
  GM.startUp();
  new Walker;
  GM.run();
  GM.shutDown();
  return 0;
}
