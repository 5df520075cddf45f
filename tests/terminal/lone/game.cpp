// A single-player game as students write them: without network and players, with its state in globals.
// OwnMainTest.cpp uses it.
#include <stdlib.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "LogManager.h"
#include "Object.h"
#include "ViewObject.h"
#include "WorldManager.h"

using namespace df;

bool over = false;
int quit_at = 0;
std::string guests;  // joins (+id) and leaves (-id) of all runs

class Walker : public Object {
 public:
  Walker() {
    setType("Walker");
    setPosition(Vector(40, 12));
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == STEP_EVENT) {
      if (over) GM.setGameOver();
      return 1;
    }
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    const EventKeyboard* p_k = (const EventKeyboard*)p_e;
    if (p_k->getKeyboardAction() != KEY_PRESSED) return 1;
    if (p_k->getKey() == Keyboard::Q) {
      quit_at = GM.getStepCount();
      GM.setGameOver();
    }
    if (p_k->getKey() == Keyboard::X) over = true;
    if (p_k->getKey() == Keyboard::C) abort();
    if (p_k->getKey() == Keyboard::RIGHTARROW) {
      step++;
      std::cout << "printed in step " << step << std::endl;
    }
    return 1;
  }
  int draw() {
    return DM.drawString(getPosition(), "WALKED-" + std::string(1, "0$%&*"[step % 5]), LEFT_JUSTIFIED,
                         YELLOW);
  }

 private:
  int step = 0;
};

// Any key ends the title, and with it GM.run(), which main() calls for the title alone.
class Title : public Object {
 public:
  Title() {
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == KEYBOARD_EVENT) seen = true;
    if (p_e->getType() == STEP_EVENT && seen) {
      WM.markForDelete(this);
      GM.setGameOver();
    }
    return 1;
  }
  int draw() { return DM.drawString(Vector(40, 6), "TITLE", LEFT_JUSTIFIED, GREEN); }

 private:
  bool seen = false;
};

// Records joins and leaves, like a game for several players.
class Usher : public Object {
 public:
  Usher() {
    registerInterest(JOIN_EVENT);
    registerInterest(LEAVE_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == JOIN_EVENT) guests += "+" + std::to_string(((const EventJoin*)p_e)->getPlayer());
    if (p_e->getType() == LEAVE_EVENT) guests += "-" + std::to_string(((const EventLeave*)p_e)->getPlayer());
    return 1;
  }
};

int main() {
  GM.startUp();
  LM.setFlush(true);
  if (getenv("LONE_USHER") != NULL) new Usher;
  if (getenv("LONE_TITLE") != NULL) {
    new Title;
    GM.run();
  }
  new Walker;
  std::cout << "before the game" << std::endl;
  GM.run();
  if (getenv("LONE_USHER") != NULL)
    std::cout << "guests " << guests << ", ticks after q: " << GM.getStepCount() - quit_at << std::endl;
  std::cout << "after the game, walker " << WM.objectsOfType("Walker").getCount() << std::endl;
  GM.shutDown();
  return 0;
}
