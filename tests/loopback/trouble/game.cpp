// A game that fails in many ways, one key for each. TroubleTest.cpp uses it.
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventStep.h"
#include "GameManager.h"
#include "LogManager.h"
#include "Object.h"
#include "ResourceManager.h"
#include "WorldManager.h"

using namespace df;

namespace {

volatile bool g_endless = true;
volatile int g_zero = 0;
int* volatile g_p_null = NULL;

int deeper(int depth) {
  volatile char room[1000];
  room[depth % 1000] = (char)depth;
  return g_endless ? deeper(depth + 1) + room[0] : 0;
}

class Trouble : public Object {
 public:
  Trouble() {
    setType("Trouble");
    setPosition(Vector(40, 12));
    registerInterest(KEYBOARD_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    const EventKeyboard* p_k = (const EventKeyboard*)p_e;
    if (p_k->getKeyboardAction() != KEY_PRESSED) return 1;
    LM.writeLog("a key\033[2J");
    if (p_k->getKey() == Keyboard::R) exit(deeper(0));
    if (p_k->getKey() == Keyboard::A) abort();
    if (p_k->getKey() == Keyboard::D) m_crashes = true;
    if (p_k->getKey() == Keyboard::K) raise(SIGKILL);
    if (p_k->getKey() == Keyboard::Z) m_rest = 7 / g_zero;  // 1 / x is compiled without a division
    if (p_k->getKey() == Keyboard::N) {
      Event inner;
      inner.setType("inner");
      WM.onEvent(&inner);
      m_rest = *g_p_null;
    }
    if (p_k->getKey() == Keyboard::S) usleep(400000);
    if (p_k->getKey() == Keyboard::P) fprintf(stderr, "the game prints\n");
    for (volatile bool hangs = p_k->getKey() == Keyboard::H; hangs;) {
    }
    return 1;
  }
  int draw() {
    if (m_crashes) m_rest = *g_p_null;
    return DM.drawString(getPosition(), "TROUBLE", CENTER_JUSTIFIED, YELLOW);
  }

 private:
  bool m_crashes = false;
  int m_rest = 0;
};

class Inner : public Object {
 public:
  Inner() { registerInterest("inner"); }
  int eventHandler(const Event*) { return 1; }
};

class Exits : public Object {
 public:
  Exits() { registerInterest(STEP_EVENT); }
  int eventHandler(const Event*) { exit(0); }
};

/// Makes the mistake named in the variable TROUBLE, which needs no player. Returns 0 if none is chosen.
int makeMistake() {
  const char* p_which = getenv("TROUBLE");
  if (p_which == NULL) return 0;
  const std::string which = p_which;
  if (which != "no-start") GM.startUp();
  if (which == "exit") new Exits;
  if (which == "exit" || which == "no-start") GM.run();
  if (which == "crash-before-run") {
    RM.loadSprite("no/such.txt", "ship");
    return *g_p_null;
  }
  return 1;
}

}  // namespace

int main() {
  if (makeMistake() != 0) return 0;
  GM.startUp();
  new Trouble;
  new Inner;
  GM.run();
  GM.shutDown();
  return 0;
}
