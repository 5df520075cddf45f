// A game that forks 300 children when its player presses F. Every second one starts its own session, which
// signals for its parent's group do not reach.
#include <sys/prctl.h>
#include <unistd.h>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventOut.h"
#include "GameManager.h"
#include "Object.h"

namespace {

constexpr int kChildren = 300;

void forkChildren() {
  for (int i = 0; i < kChildren; ++i) {
    if (fork() != 0) continue;
    prctl(PR_SET_NAME, "attack-fork");
    if (i % 2 != 0) setsid();
    for (;;) pause();
  }
}

class Forker : public df::Object {
 public:
  Forker() {
    setSolidness(df::SPECTRAL);
    registerInterest(df::KEYBOARD_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::KEYBOARD_EVENT) return 0;
    const auto* p_key = static_cast<const df::EventKeyboard*>(p_e);
    if (p_key->getKeyboardAction() == df::KEY_PRESSED && p_key->getKey() == df::Keyboard::F) forkChildren();
    return 1;
  }
  int draw() override { return DM.drawCh(df::Vector(40, 12), 'F', df::YELLOW); }
};

// A visibly moving object.
class Drifter : public df::Object {
 public:
  explicit Drifter(int n) {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(n * 7 % 80, n % 10));
    setVelocity(df::Vector(0.1f * static_cast<float>(n % 5 + 1), 0.03f * static_cast<float>(n % 3)));
    registerInterest(df::OUT_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) setPosition(df::Vector(0, 1));
    return 1;
  }
  int draw() override { return DM.drawCh(getPosition(), 'o', df::CYAN); }
};

}  // namespace

int main() {
  if (GM.startUp()) return 1;
  new Forker;
  for (int i = 0; i < 12; ++i) new Drifter(i);
  GM.run();
  GM.shutDown();
  return 0;
}
