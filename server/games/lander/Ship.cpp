#include "Ship.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "DisplayManager.h"
#include "EventOut.h"
#include "Ground.h"
#include "HighScores.h"
#include "PhysicsManager.h"
#include "Seconds.h"

namespace {

constexpr double kMainEngine = 5;  // cells per second²; the moon's gravity is 2
constexpr double kSideJet = 4;
constexpr double kTank = 14;     // seconds for which the fuel lasts in the main engine
constexpr double kGentle = 2.2;  // maximum speed of a landing, cells per second
constexpr int kBurnTicks = 5;    // ticks for which a key burns without a repeat or release
constexpr int kTapTicks = 2;     // maximum ticks of burning after a key's release
constexpr int kStandTicks = 20;  // ticks that a ship must stand before its landing counts
constexpr int kWaitTicks = 75;
constexpr std::uint32_t kStatusText = 0;
constexpr std::uint32_t kMessageText = 1;

}  // namespace

Ship::Ship(df::Player& player) : PlayerObject(player) {
  setType("Ship");
  setAltitude(3);
  setBoxShape(3, 2);
  setRestitution(0.2);
  setFriction(0.8);
  launch();
}

int Ship::handle(const df::Event* p_e) {
  if (p_e->getType() == df::COLLISION_EVENT) touch(*static_cast<const df::EventCollision*>(p_e));
  if (p_e->getType() == df::OUT_EVENT && m_wait == 0) crash("Lost in space");
  return 1;
}

void Ship::launch() {
  const auto place =
      WM.findFree(getBox(), df::Vector(DM.getHorizontal() / 4.0 + WM.randomInt(DM.getHorizontal() / 2), 3));
  setPosition(place.value_or(df::Vector(DM.getHorizontal() / 2.0, 3)));
  setVelocity(df::perSecond(df::Vector(WM.randomInt(5) - 2, 0)));
  setGravityScale(1);
  setSolidness(df::HARD);
  setVisible(true);
  m_fuel = kTank;
  m_wait = m_standing = m_worth = 0;
  m_message = "up, left and right: jets. Set down gently on a green pad";
}

void Ship::keyboard(const df::EventKeyboard& event) {
  const bool down = event.getKeyboardAction() != df::KEY_RELEASED;
  const auto set = [&](Jet jet) { m_burning[jet] = down ? kBurnTicks : std::min(m_burning[jet], kTapTicks); };
  switch (event.getKey()) {
    case df::Keyboard::UPARROW:
    case df::Keyboard::W:
    case df::Keyboard::SPACE:
      return set(MAIN);
    case df::Keyboard::LEFTARROW:
    case df::Keyboard::A:
      return set(LEFT);
    case df::Keyboard::RIGHTARROW:
    case df::Keyboard::D:
      return set(RIGHT);
    default:
      return;
  }
}

void Ship::burn(Jet jet) {
  if (m_burning[jet] == 0 || m_fuel <= 0) return;
  --m_burning[jet];
  m_fuel -= df::perSecond(jet == MAIN ? 1 : 0.3);
  const df::Vector push =
      jet == MAIN ? df::Vector(0, -kMainEngine) : df::Vector(jet == LEFT ? -kSideJet : kSideJet, 0);
  applyForce(df::perSecondSquared(push));  // the ship's mass is 1
}

void Ship::step() {
  if (m_wait > 0) {
    if (--m_wait == 0) launch();
  } else {
    for (const Jet jet : {MAIN, LEFT, RIGHT}) burn(jet);
    const bool still = getVelocity().getMagnitude() < df::perSecond(0.1);
    m_standing = still && m_worth > 0 ? m_standing + 1 : 0;
    if (m_standing == kStandTicks) land(m_worth);
  }
  showStatus(*getPlayer());
}

// Handles a collision. Its strength is the change of velocity, which is impulse over mass.
void Ship::touch(const df::EventCollision& event) {
  if (m_wait > 0) return;
  const df::Object* p_other = event.getObject1() == this ? event.getObject2() : event.getObject1();
  const double speed = event.getImpulse() / getMass() * df::TICKS_PER_SECOND;
  const auto* p_ground = dynamic_cast<const Ground*>(p_other);
  if (speed > kGentle) return crash("Crashed: that was faster than 2.2");
  if (p_ground == nullptr) return;  // it hit another ship
  if (p_ground->getWorth() == 0) return crash("Crashed: rocks are no place to land");
  m_worth = p_ground->getWorth();
}

void Ship::land(int worth) {
  const int points = worth + static_cast<int>(10 * m_fuel);
  df::Player& player = *getPlayer();
  player.setScore(player.getScore() + points);
  m_message = "Landed: " + std::to_string(points) + " points.";
  df::HighScores landings("landings");
  landings.add(player.getName(), points);
  for (const df::HighScore& best : landings.best(1))
    m_message += " The best landing: " + best.name + ", " + std::to_string(best.points);
  m_wait = kWaitTicks;
}

void Ship::crash(const std::string& why) {
  m_message = why;
  m_wait = kWaitTicks;
  setVelocity(df::Vector());
  setGravityScale(0);
  setSolidness(df::SPECTRAL);
}

int Ship::draw() {
  const df::Vector at = getPosition();
  const df::Vector upper = at + df::Vector(-1, -0.5);  // left end of the upper row
  const df::Vector lower = at + df::Vector(-1, 0.5);
  if (getSolidness() == df::SPECTRAL) {  // draws wreckage
    DM.drawString(upper, "\\*/", df::LEFT_JUSTIFIED, df::RED);
    return DM.drawString(lower, "/*\\", df::LEFT_JUSTIFIED, df::RED);
  }
  DM.drawString(upper, "/O\\", df::LEFT_JUSTIFIED, getColor());
  DM.drawString(lower, "/ \\", df::LEFT_JUSTIFIED, getColor());
  if (m_fuel <= 0) return 0;
  if (m_burning[MAIN] > 0) DM.drawCh(lower + df::Vector(1, 0), 'W', df::RED);
  if (m_burning[LEFT] > 0) DM.drawCh(upper + df::Vector(3, 0), '>', df::RED);
  if (m_burning[RIGHT] > 0) DM.drawCh(upper + df::Vector(-1, 0), '<', df::RED);
  return 0;
}

void Ship::showStatus(df::Player& player) const {
  const df::Vector v = getVelocity();
  char text[80];
  std::snprintf(text, sizeof text, "%d points   fuel %4.1f   down %5.1f   aside %5.1f", player.getScore(),
                std::max(0.0, m_fuel), v.y() * df::TICKS_PER_SECOND, std::abs(v.x()) * df::TICKS_PER_SECOND);
  const bool gentle = v.getMagnitude() * df::TICKS_PER_SECOND < kGentle;
  player.setText(kStatusText, df::Vector(1, 0), text, gentle ? df::GREEN : df::WHITE);
  const double left = (DM.getHorizontal() - static_cast<double>(m_message.size())) / 2;
  player.setText(kMessageText, df::Vector(left, 1), m_message, getColor());
}
