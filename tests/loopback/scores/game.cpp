// A game that adds a score for each key of any player. RecoveryTest.cpp uses it.
#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "GameManager.h"
#include "HighScores.h"
#include "Object.h"

using namespace df;

namespace {

class Counter : public Object {
 public:
  Counter() {
    setType("Counter");
    setPosition(Vector(40, 12));
    registerInterest(KEYBOARD_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    const EventKeyboard* p_k = (const EventKeyboard*)p_e;
    if (p_k->getKeyboardAction() != KEY_PRESSED) return 1;
    m_keys++;
    HighScores(m_keys % 2 == 0 ? "even" : "odd").add("counter", m_keys);
    return 1;
  }
  int draw() {
    return DM.drawString(getPosition(), "keys=" + std::to_string(m_keys) + ";", CENTER_JUSTIFIED, YELLOW);
  }

 private:
  int m_keys = 0;
};

}  // namespace

int main() {
  GM.startUp();
  new Counter;
  GM.run();
  GM.shutDown();
  return 0;
}
