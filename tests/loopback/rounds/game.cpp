// A game that knows nothing about players and keeps its state in globals, like programs for one player.
// RoundsTest.cpp uses it.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventOut.h"
#include "EventStep.h"
#include "GameManager.h"
#include "HighScores.h"
#include "LogManager.h"
#include "Music.h"
#include "Object.h"
#include "WorldManager.h"

using namespace df;

int mains = 0;  // incremented by main(); a value other than 1 shows that a global variable outlived a round
int steps = 0;
bool over = false;

class Walker : public Object {
 public:
  Walker() {
    setType("Walker");
    setPosition(Vector(40, 12));
    setAltitude(MAX_ALTITUDE);  // otherwise a passing Drifter would hide a part of the text
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == STEP_EVENT) {
      if (over) GM.setGameOver();
      if (getenv("ROUNDS_CRASH_AT_ONCE") != NULL) abort();
      return 1;
    }
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    const EventKeyboard* p_k = (const EventKeyboard*)p_e;
    if (p_k->getKeyboardAction() != KEY_PRESSED) return 1;
    if (p_k->getKey() == Keyboard::Q) GM.setGameOver();
    if (p_k->getKey() == Keyboard::X) over = true;
    if (p_k->getKey() == Keyboard::C) abort();
    if (p_k->getKey() == Keyboard::H) pause();
    if (p_k->getKey() == Keyboard::P) {
      printf("printed \x1b[31mred\n");
      fflush(stdout);
    }
    if (p_k->getKey() == Keyboard::L) LM.writeLog("logged \x1b[31mred");
    if (p_k->getKey() == Keyboard::RIGHTARROW) steps++;
    if (p_k->getKey() == Keyboard::S) HighScores("steps").add("walker", steps);
    return 1;
  }
  int draw() {
    const std::vector<HighScore> best = HighScores("steps").best(1);
    return DM.drawString(getPosition(),
                         "mains=" + std::to_string(mains) + " steps=" + std::to_string(steps) +
                             " process=" + std::to_string(getpid()) +
                             " best=" + std::to_string(best.empty() ? -1 : best[0].points) + ";",
                         CENTER_JUSTIFIED, YELLOW);
  }
};

// A visibly moving object.
class Drifter : public Object {
 public:
  explicit Drifter(int n) {
    setType("Drifter");
    setSolidness(SPECTRAL);
    setPosition(Vector(n * 7 % 80, n % 10));
    setVelocity(Vector(0.1f * (float)(n % 5 + 1), 0.03f * (float)(n % 3)));
    registerInterest(OUT_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == OUT_EVENT) setPosition(Vector(0, 1));
    return 1;
  }
  int draw() { return DM.drawCh(getPosition(), 'o', CYAN); }
};

int main() {
  mains++;
  GM.startUp();
  new Walker;
  Music theme;
  theme.setLabel("theme");
  theme.play();
  for (int i = 0; i < 12; i++) new Drifter(i);
  GM.run();
  GM.shutDown();
  return 0;
}
