// A game for a room. It fails in each way that must not affect other rooms. NamedRoomsTest.cpp uses it.
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <string>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Object.h"

using namespace df;

namespace {

volatile bool g_hangs = true;

/// Returns the id of this process, to be drawn. In tests with replays it is a constant, because replays must
/// be equal.
int process() {
  return getenv("ROOM_REPEATS") != NULL ? 1 : getpid();
}

double cpuSeconds() {
  timespec spent;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent);
  return (double)spent.tv_sec + (double)spent.tv_nsec * 1e-9;
}

class Teller : public Object {
 public:
  Teller() {
    setType("Teller");
    setPosition(Vector(40, 12));
    registerInterest(KEYBOARD_EVENT);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) {
    if (p_e->getType() == STEP_EVENT) {
      m_ticks++;
      if (m_dozes) usleep(50000);
      for (const double end = cpuSeconds() + 0.1; m_burns && cpuSeconds() < end;) {
      }
      return 1;
    }
    if (p_e->getType() != KEYBOARD_EVENT) return 0;
    const EventKeyboard* p_k = (const EventKeyboard*)p_e;
    if (p_k->getKeyboardAction() != KEY_PRESSED) return 1;
    m_keys++;
    if (p_k->getKey() == Keyboard::B) m_burns = true;
    if (p_k->getKey() == Keyboard::S) m_dozes = true;
    if (p_k->getKey() == Keyboard::C) abort();
    while (p_k->getKey() == Keyboard::H && g_hangs) {
    }
    return 1;
  }
  int draw() {
    return DM.drawString(getPosition(),
                         "process=" + std::to_string(process()) + " keys=" + std::to_string(m_keys) +
                             " ticks=" + std::to_string(m_ticks) + ";",
                         CENTER_JUSTIFIED, YELLOW);
  }

 private:
  int m_ticks = 0;
  int m_keys = 0;
  bool m_burns = false;
  bool m_dozes = false;
};

// Aborts in its first tick. Created in each new world while a file "fails" exists.
class Failing : public Object {
 public:
  Failing() { registerInterest(STEP_EVENT); }
  int eventHandler(const Event*) { abort(); }
};

}  // namespace

int main() {
  GM.startUp();
  new Teller;
  if (access("fails", F_OK) == 0) new Failing;
  GM.run();
  GM.shutDown();
  return 0;
}
