#include "Hero.h"

#include <algorithm>
#include <cmath>

#include "Bullet.h"
#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventMouse.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "Events.h"
#include "Explosion.h"
#include "Field.h"
#include "Saucer.h"
#include "Sprites.h"
#include "WorldManager.h"

namespace {

// Speeds in cells per tick. A cell is about twice as high as wide, so both look equally fast.
constexpr double kSpeedAcross = 1;
constexpr double kSpeedDown = 0.5;

constexpr int kShieldTicks = 60;
constexpr int kLostTicks = 60;
constexpr int kHintTicks = 240;
constexpr int kGunTicks = 6;
constexpr int kMaxBullets = 128;  // limit for all ships together
constexpr int kMaxNukes = 3;
constexpr int kHitsPerNuke = 20;
constexpr double kAimRows = 2;  // rows above and below the ship within which saucers are targets

/// The ship has full speed while a key is down, then moves on to the next whole cell, so that a tap of a key
/// moves it by one cell. Keys are declared, so that the pilot's client shows the movement at once, even far
/// away.
df::Controls flightControls() {
  using namespace df::Keyboard;
  df::Controls controls;
  for (const Key key : {LEFTARROW, A}) controls.onKey(key).drive(-kSpeedAcross, 0);
  for (const Key key : {RIGHTARROW, D}) controls.onKey(key).drive(kSpeedAcross, 0);
  for (const Key key : {UPARROW, W}) controls.onKey(key).drive(0, -kSpeedDown);
  for (const Key key : {DOWNARROW, S}) controls.onKey(key).drive(0, kSpeedDown);
  return controls.toWholeCells()
      .within(df::Box(df::Vector(3, topRow()), fieldWidth() - 7, bottomRow() - topRow()))
      .releaseAfter(Trigger::kPatience);
}

}  // namespace

Hero::Hero(df::Player& player)
    : m_player(player.getId()),
      m_name(player.getName()),
      m_color(player.getColor()),
      m_hint_wait(kHintTicks) {
  setType("Hero");
  setAltitude(3);
  setSprite(inColor("ship", m_color), false);
  setBox(df::Box(df::Vector(-2, -0.4), 4, 0.8));  // only the body of the ship can be hit, not the wings
  registerInterest(df::STEP_EVENT);
  registerInterest(df::KEYBOARD_EVENT);
  registerInterest(df::MSE_EVENT);
  registerInterest(df::LEAVE_EVENT);
  registerInterest(SHOT_DOWN_EVENT);
  registerInterest(ROUND_EVENT);
  player.setObject(this);
  player.setControls(flightControls());
  player.setScore(0);
  launch();
}

int Hero::eventHandler(const df::Event* p_e) {
  const auto& type = p_e->getType();
  if (type == df::STEP_EVENT) {
    step();
  } else if (type == df::KEYBOARD_EVENT) {
    const auto& event = *static_cast<const df::EventKeyboard*>(p_e);
    if (event.getPlayer() == m_player) keyboard(event);
  } else if (type == df::MSE_EVENT) {
    const auto& event = *static_cast<const df::EventMouse*>(p_e);
    if (event.getPlayer() == m_player) mouse(event);
  } else if (type == df::COLLISION_EVENT) {
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    for (df::Object* p_o : {p_collision->getObject1(), p_collision->getObject2()}) {
      if (p_o->getType() != "Saucer" || m_lost) continue;
      if (static_cast<Saucer*>(p_o)->explode()) lose();
    }
  } else if (type == SHOT_DOWN_EVENT) {
    const bool mine = static_cast<const EventShotDown*>(p_e)->getPlayer() == m_player;
    if (mine && m_nukes < kMaxNukes && ++m_hits == kHitsPerNuke) {
      m_hits = 0;
      ++m_nukes;
    }
  } else if (type == df::LEAVE_EVENT) {
    if (static_cast<const df::EventLeave*>(p_e)->getPlayer() == m_player) WM.markForDelete(this);
  } else if (type == ROUND_EVENT) {
    if (static_cast<const EventRound*>(p_e)->getPart() == EventRound::TITLE) retire();
  } else {
    return 0;
  }
  return 1;
}

void Hero::step() {
  df::Player* p_player = WM.getPlayer(m_player);
  if (p_player == nullptr) return;

  m_trigger.step();
  if (m_gun_wait > 0) --m_gun_wait;
  if (m_hint_wait > 0) --m_hint_wait;
  if (!isSpent() && m_wait > 0 && --m_wait == 0) {
    if (m_lost) {
      launch();
    } else {
      setSolidness(df::SOFT);  // the shield has ended
    }
  }
  if (!m_lost && m_trigger.isPulled()) fire(aimAhead());
  showStatus(*p_player);
  showMessage(*p_player);
}

// --- actions of the player: keys, gun and nuke

void Hero::keyboard(const df::EventKeyboard& event) {
  m_trigger.key(event);
  if (m_lost || event.getKeyboardAction() != df::KEY_PRESSED) return;
  if (event.getKey() == df::Keyboard::SPACE) fire(aimAhead());
  if (event.getKey() == df::Keyboard::N || event.getKey() == df::Keyboard::RETURN) fireNuke();
}

void Hero::mouse(const df::EventMouse& event) {
  const bool pulls_trigger = event.getMouseAction() != df::MOVED && event.getMouseButton() == df::Mouse::LEFT;
  if (pulls_trigger && !m_lost) fire(event.getMousePosition() - nose());
}

void Hero::fire(df::Vector direction) {
  if (m_gun_wait > 0 || WM.objectsOfType("Bullet").getCount() >= kMaxBullets) return;
  if (direction == df::Vector()) direction = df::Vector(1, 0);  // the click was on the ship itself
  m_gun_wait = kGunTicks;
  new Bullet(m_player, m_color, nose(), direction);
}

df::Vector Hero::nose() const {
  return getPosition() + df::Vector(3, 0);
}

df::Vector Hero::aimAhead() const {
  df::Vector direction(1, 0);
  double nearest = fieldWidth() - nose().x();  // saucers beyond the screen's edge are not targets
  const df::ObjectList saucers = WM.objectsOfType("Saucer");
  df::ObjectListIterator li(&saucers);
  for (li.first(); !li.isDone(); li.next()) {
    const df::Vector way = li.currentObject()->getPosition() - nose();
    if (way.x() <= 0 || way.x() >= nearest || std::abs(way.y()) > kAimRows) continue;
    nearest = way.x();
    // Aims at the point where the saucer will be when the bullet reaches it.
    df::Vector saucer_moves = li.currentObject()->getVelocity();
    saucer_moves.scale(way.x() / (Bullet::kSpeed - saucer_moves.x()));
    direction = way + saucer_moves;
  }
  return direction;
}

void Hero::fireNuke() {
  if (m_nukes == 0) return;
  --m_nukes;
  const EventNuke nuke;
  WM.onEvent(&nuke);
}

// --- launch and loss of ships

void Hero::launch() {
  m_lost = false;
  m_wait = kShieldTicks;
  m_nukes = std::max(1, m_nukes);
  WM.getPlayer(m_player)->setSteering();
  setPosition(freePlace());
  setSolidness(df::SPECTRAL);  // nothing touches a shielded ship
  setVisible(true);
}

df::Vector Hero::freePlace() {
  // The place must have more room than the ship needs, most of it in front. If the sky is too full for that,
  // the last place after some attempts is used, because a shield protects the new ship.
  const df::Box ship = getBox();
  setBox(df::Box(df::Vector(-4, -2), 18, 4));
  df::Vector place;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const int rows = static_cast<int>(bottomRow() - topRow()) - 3;
    const int row = WM.randomInt(rows);  // row first, because compilers evaluate arguments in any order
    place = df::Vector(6 + WM.randomInt(8), topRow() + 2 + row);
    if (!WM.isCollision(this, place)) break;
  }
  setBox(ship);
  return place;
}

void Hero::lose() {
  df::Player* p_player = WM.getPlayer(m_player);
  if (p_player == nullptr) return;  // the player leaves in this tick
  m_lost = true;
  m_wait = kLostTicks;
  m_hint_wait = 0;
  --m_ships;
  p_player->setSteering(false);
  setVelocity(df::Vector());
  setSolidness(df::SPECTRAL);
  setVisible(false);
  explodeShip(getPosition());
  showMessage(*p_player);
  const EventShipLost ship_lost(m_name, p_player->getScore(), isSpent());
  WM.onEvent(&ship_lost);
}

void Hero::retire() {
  if (df::Player* p_player = WM.getPlayer(m_player)) {
    for (const TextId text : {STATUS_TEXT, MESSAGE_TEXT}) p_player->setText(text, df::Vector(), "");
  }
  WM.markForDelete(this);
}

// --- drawing

int Hero::draw() {
  const df::Vector at = getPosition();
  if (m_wait > 0) {  // a new ship: show its owner's name and a flickering shield
    DM.drawString(at + df::Vector(-2, -2), m_name, df::LEFT_JUSTIFIED, m_color);
    if (m_wait / 4 % 2 == 0) DM.drawCh(at + df::Vector(4, 0), ')', m_color);
  }
  return df::Object::draw();
}

void Hero::showStatus(df::Player& player) const {
  std::string text = std::to_string(player.getScore()) + " points  ships " + std::to_string(m_ships) +
                     "  nukes " + std::to_string(m_nukes);
  player.setText(STATUS_TEXT, df::Vector(1, 0), text, m_color);
}

void Hero::showMessage(df::Player& player) const {
  std::string text;
  if (isSpent()) {
    text = "Hit! That was your last ship.";
  } else if (m_lost) {
    text = "Hit! The next ship is on its way.";
  } else if (m_hint_wait > 0) {
    text = "arrows or WASD: fly   space: shoot   click: aim   N: nuke";
  }
  const double left = (fieldWidth() - static_cast<double>(text.size())) / 2;
  player.setText(MESSAGE_TEXT, df::Vector(left, fieldHeight() - 2), text);
}
