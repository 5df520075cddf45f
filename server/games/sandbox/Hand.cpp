#include "Hand.h"

#include <string>

#include "DisplayManager.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "Ragdoll.h"
#include "Seconds.h"
#include "Things.h"
#include "World.h"
#include "WorldManager.h"

namespace {

constexpr double kStrength = 3;  // of a hand: force, of bodies with masses near 1
constexpr int kLetGo = 4;        // ticks without news of the button
constexpr int kVoteTicks = 15 * 30;
constexpr int kMostThings = 150;
constexpr int kMostBlobs = 8;      // a heap of them is dear
constexpr double kShotSpeed = 60;  // cells per second
const df::Vector kMuzzle(40, 1);   // where shots come from

}  // namespace

Hand::Hand(df::Player& player) : m_player(player.getId()), m_color(player.getColor()) {
  setType("Hand");
  setSolidness(df::SPECTRAL);
  setAltitude(4);
  setPosition(df::Vector(40, 10));
  registerInterest(df::STEP_EVENT);
  registerInterest(df::MSE_EVENT);
  registerInterest(df::KEYBOARD_EVENT);
  registerInterest(df::LEAVE_EVENT);
  player.setObject(this);
  player.setText(
      0, df::Vector(1, 0),
      "drag: left button  shoot: right  C crate  B ball  R ragdoll  X blob  G: vote to turn gravity");
}

Hand::~Hand() {
  m_grip.remove();
  const df::World* p_world = getWorld();
  if (p_world == nullptr) return;  // it is over
  if (df::SoftBody* p_soft = held()) p_soft->release();
}

int Hand::eventHandler(const df::Event* p_e) {
  const auto& type = p_e->getType();
  if (type == df::STEP_EVENT) {
    step();
  } else if (type == df::MSE_EVENT) {
    const auto& event = *static_cast<const df::EventMouse*>(p_e);
    if (event.getPlayer() == m_player) mouse(event);
  } else if (type == df::KEYBOARD_EVENT) {
    const auto& event = *static_cast<const df::EventKeyboard*>(p_e);
    if (event.getPlayer() == m_player && event.getKeyboardAction() == df::KEY_PRESSED) keyboard(event);
  } else if (type == df::LEAVE_EVENT) {
    if (static_cast<const df::EventLeave*>(p_e)->getPlayer() == m_player) WM.markForDelete(this);
  } else {
    return 0;
  }
  return 1;
}

void Hand::step() {
  if (m_wants_turn > 0) --m_wants_turn;
  if (++m_since_held > kLetGo) letGo();  // it flies on as fast as it was dragged
}

void Hand::mouse(const df::EventMouse& event) {
  setPosition(event.getMousePosition());
  if (event.getMouseAction() == df::CLICKED && event.getMouseButton() == df::Mouse::LEFT) grab(getPosition());
  if (event.getMouseAction() == df::CLICKED && event.getMouseButton() == df::Mouse::RIGHT)
    shoot(getPosition());
  if (event.getMouseAction() != df::MOVED && event.getMouseButton() == df::Mouse::LEFT) m_since_held = 0;
  m_grip.setTarget(getPosition());  // -1 if nothing is held
  if (df::SoftBody* p_soft = held()) p_soft->dragTo(getPosition());
}

df::SoftBody* Hand::held() const {
  return static_cast<df::SoftBody*>(getWorld()->find(m_soft));
}

void Hand::letGo() {
  m_grip.remove();
  if (df::SoftBody* p_soft = held()) p_soft->release();
  m_soft = {};
}

void Hand::grab(df::Vector where) {
  letGo();
  const df::ObjectList things = WM.objectsSeenAt(where);
  df::ObjectListIterator li(&things);
  for (li.first(); !li.isDone(); li.next()) {
    if (auto* p_soft = dynamic_cast<df::SoftBody*>(li.currentObject())) {
      if (p_soft->isGrabbed()) continue;  // by somebody else
      p_soft->grab(where, kStrength * p_soft->getMass());
      m_soft = p_soft->key();
      return;
    }
    auto* p_body = dynamic_cast<df::Body*>(li.currentObject());
    if (p_body == nullptr) continue;
    m_grip = PM.addMouse(p_body, where, kStrength * p_body->getMass());
    return;
  }
}

void Hand::shoot(df::Vector where) {
  df::Vector way = where - kMuzzle;
  way.normalize();
  auto* p_ball = new Ball(kMuzzle + way, m_color, 0.8, 0.3);
  way.scale(df::perSecond(kShotSpeed));
  p_ball->setVelocity(way);
}

void Hand::keyboard(const df::EventKeyboard& event) {
  if (event.getKey() == df::Keyboard::G) m_wants_turn = kVoteTicks;
  if (WM.objectsOfType("Thing").getCount() >= kMostThings) return;
  switch (event.getKey()) {
    case df::Keyboard::C:
      new Crate(getPosition(), m_color);
      break;
    case df::Keyboard::B:
      new Ball(getPosition(), m_color);
      break;
    case df::Keyboard::X:
      if (WM.objectsOfType("Blob").getCount() < kMostBlobs) makeBlob(getPosition(), m_color);
      break;
    case df::Keyboard::R:
      df::makeRagdoll(getPosition(), 8, 8, m_color);
      break;
    default:
      break;
  }
}

int Hand::draw() {
  return DM.drawCh(getPosition(), m_grip.exists() || held() != nullptr ? '*' : '+', m_color);
}
