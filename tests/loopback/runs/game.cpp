// A game that calls GM.run() several times, as for a title, a level and an epilogue. RunsTest.cpp uses it,
// with a letter for each step of main() in the variable RUNS.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Object.h"
#include "Particle.h"
#include "WorldManager.h"
#include "utility.h"

using namespace df;

// Ends its run: kind 'r' in the step after a key, 'k' at a key, 's' by itself, 100 steps after two players
// joined.
class Act : public Object {
 public:
  Act(int new_number, char new_kind) : number(new_number), kind(new_kind) {
    setType("Act");
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
    registerInterest(JOIN_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == JOIN_EVENT) joins++;
    if (p_e->getType() == KEYBOARD_EVENT && ((const EventKeyboard*)p_e)->getKey() == Keyboard::SPACE)
      pressed = true;
    if (p_e->getType() == STEP_EVENT && joins == 2) steps++;
    const bool is_time = p_e->getType() == (kind == 'k' ? KEYBOARD_EVENT : STEP_EVENT);
    if (is_time && (kind == 's' ? steps == 100 : pressed)) {
      WM.markForDelete(this);
      GM.setGameOver();
    }
    return 1;
  }
  int draw() {
    return DM.drawString(Vector(40, 12),
                         "act=" + std::to_string(number) + " joins=" + std::to_string(joins) + ";",
                         CENTER_JUSTIFIED, YELLOW);
  }

 private:
  int number;
  char kind;
  int joins = 0;
  int steps = 0;
  bool pressed = false;
};

int main() {
  GM.startUp();
  new Object;  // stays until the world is cleared
  int acts = 0;
  for (const char* p_step = getenv("RUNS"); *p_step != '\0'; p_step++) {
    if (strchr("rks", *p_step) != NULL) {
      new Act(++acts, *p_step);
      GM.run();
    }
    if (*p_step == 'e') splash();
    if (*p_step == 'p') sleep(1);  // as a game does that waits for the clock
    if (*p_step == 'c') {
      ObjectList all = WM.getAllObjects();
      for (int i = 0; i < all.getCount(); i++) delete all[i];
    }
    if (*p_step == 'w') WM.shutDown();
    if (*p_step == 'g') {
      GM.shutDown();
      GM.startUp();
    }
  }
  GM.shutDown();
  return 0;
}
