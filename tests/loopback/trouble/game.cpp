// A game that goes wrong, one key for each way. What it is good for is in TroubleTest.cpp.
#include <stdio.h>
#include <stdlib.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "GameManager.h"
#include "Object.h"

using namespace df;

namespace {

volatile bool g_endless = true;

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
    if (p_k->getKey() == Keyboard::R) exit(deeper(0));
    if (p_k->getKey() == Keyboard::A) abort();
    if (p_k->getKey() == Keyboard::P) fprintf(stderr, "the game prints\n");
    for (volatile bool hangs = p_k->getKey() == Keyboard::H; hangs;) {
    }
    return 1;
  }
  int draw() { return DM.drawString(getPosition(), "TROUBLE", CENTER_JUSTIFIED, YELLOW); }
};

}  // namespace

int main() {
  GM.startUp();
  new Trouble;
  GM.run();
  GM.shutDown();
  return 0;
}
