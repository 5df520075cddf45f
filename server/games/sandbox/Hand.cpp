#include "Hand.h"

#include "DisplayManager.h"
#include "Ragdoll.h"
#include "Seconds.h"
#include "Things.h"

namespace {

constexpr int kLetGo = 4;  // ticks without a button event, after which the button counts as released
constexpr int kVoteTicks = 15 * 30;
constexpr int kMaxThings = 150;
constexpr int kMaxBlobs = 8;       // a pile of blobs is slow to compute
constexpr double kShotSpeed = 60;  // cells per second
const df::Vector kMuzzle(40, 1);   // where shots start

}  // namespace

Hand::Hand(df::Player& player) : PlayerObject(player) {
  setType("Hand");
  setSolidness(df::SPECTRAL);
  setAltitude(4);
  setPosition(df::Vector(40, 10));
  player.setText(0, df::Vector(1, 0),
                 "left drag  right shoot  C crate  B ball  R ragdoll  X blob  G gravity (a vote)");
}

void Hand::step() {
  if (m_wants_turn > 0) --m_wants_turn;
  if (++m_since_held > kLetGo) m_grip.release();  // the thing flies on as fast as it was dragged
}

void Hand::mouse(const df::EventMouse& event) {
  setPosition(event.getMousePosition());
  const bool is_left = event.getMouseButton() == df::Mouse::LEFT;
  if (event.getMouseAction() == df::CLICKED && is_left) m_grip.grab(getPosition());
  if (event.getMouseAction() == df::CLICKED && event.getMouseButton() == df::Mouse::RIGHT) shoot();
  if (event.getMouseAction() != df::MOVED && is_left) m_since_held = 0;
  m_grip.dragTo(getPosition());
}

void Hand::shoot() {
  df::Vector way = getPosition() - kMuzzle;
  way.normalize();
  auto* p_ball = new Ball(kMuzzle + way, getColor(), 0.8, 0.3);
  way.scale(df::perSecond(kShotSpeed));
  p_ball->setVelocity(way);
}

void Hand::keyboard(const df::EventKeyboard& event) {
  if (event.getKeyboardAction() != df::KEY_PRESSED) return;
  if (event.getKey() == df::Keyboard::G) m_wants_turn = kVoteTicks;
  if (WM.objectsOfType("Thing").getCount() >= kMaxThings) return;
  switch (event.getKey()) {
    case df::Keyboard::C:
      new Crate(getPosition(), getColor());
      break;
    case df::Keyboard::B:
      new Ball(getPosition(), getColor());
      break;
    case df::Keyboard::X:
      if (WM.objectsOfType("Blob").getCount() < kMaxBlobs) makeBlob(getPosition(), getColor());
      break;
    case df::Keyboard::R:
      df::makeRagdoll(getPosition(), 8, 8, getColor());
      break;
    default:
      break;
  }
}

int Hand::draw() {
  return DM.drawCh(getPosition(), m_grip.isHolding() ? '*' : '+', getColor());
}
