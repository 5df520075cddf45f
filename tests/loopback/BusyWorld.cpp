#include "BusyWorld.h"

#include <string>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"

namespace naiad::test {

namespace {

df::Vector somewhere() {
  return {static_cast<double>(WM.randomInt(8000)) / 100.0, static_cast<double>(WM.randomInt(2400)) / 100.0};
}

df::Vector somehow() {
  return {static_cast<double>(WM.randomInt(200) - 100) / 120.0,
          static_cast<double>(WM.randomInt(200) - 100) / 240.0};
}

/// Looks like one to five characters or a 2x2 sprite. Sometimes changes its velocity, its first character,
/// its visibility or its place, or is replaced by another Creature.
class Creature : public df::Object {
 public:
  Creature() {
    setType("Creature");
    setPosition(somewhere());
    setVelocity(somehow());
    setAltitude(WM.randomInt(df::MAX_ALTITUDE + 1));
    setSolidness(static_cast<df::Solidness>(WM.randomInt(3)));
    if (WM.randomInt(8) == 0) setAcceleration(df::Vector(0, 0.01));
    m_square = WM.randomInt(4) == 0;
    if (m_square) setBox(df::Box(df::Vector(-1, -1), 2, 2));
    m_color = static_cast<df::Color>(WM.randomInt(df::kColorCount));
    m_text = std::string(1 + WM.randomInt(5), static_cast<char>('a' + WM.randomInt(26)));
    registerInterest(df::STEP_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) {
      setPosition(somewhere());
      return 1;
    }
    if (p_e->getType() != df::STEP_EVENT) return 0;
    switch (WM.randomInt(300)) {
      case 0:
        setVelocity(somehow());
        break;
      case 1:
        m_text.front() = static_cast<char>('A' + WM.randomInt(26));
        break;
      case 2:
        setVisible(!isVisible());
        break;
      case 3:
        WM.markForDelete(this);
        new Creature;
        break;
      case 4:
        setPosition(somewhere());
        break;
      default:
        break;
    }
    return 1;
  }

  int draw() override {
    if (!m_square) return DM.drawString(getPosition(), m_text, df::LEFT_JUSTIFIED, m_color);
    // A sprite of even width tests cells at offsets of half a cell, whose positions are converted to floats.
    for (int i = 0; i < 4; ++i) {
      const df::Vector at(getPosition().getX() - 0.5 + i % 2, getPosition().getY() - 0.5 + i / 2);
      DM.drawCh(at, m_text.front(), m_color);
    }
    return 0;
  }

 private:
  bool m_square = false;
  df::Color m_color = df::WHITE;
  std::string m_text;
};

/// A player's ship.
class Ship : public df::Object {
 public:
  explicit Ship(df::Player& player) : m_player(player.getId()), m_color(player.getColor()) {
    setType("Ship");
    setPosition(df::Vector(40, 12));
    setSolidness(df::SPECTRAL);
    setAltitude(df::MAX_ALTITUDE);
    player.setObject(this);
    registerInterest(df::KEYBOARD_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::KEYBOARD_EVENT) return 0;
    const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_e);
    if (p_key->getPlayer() != m_player || p_key->getKeyboardAction() != df::KEY_PRESSED) return 0;
    if (p_key->getKey() == df::Keyboard::RIGHTARROW) WM.moveObject(this, getPosition() + df::Vector(1, 0));
    if (p_key->getKey() == df::Keyboard::LEFTARROW) WM.moveObject(this, getPosition() - df::Vector(1, 0));
    ++m_keys;
    if (df::Player* p_player = WM.getPlayer(m_player)) {
      p_player->setText(0, df::Vector(2, 0), "keys " + std::to_string(m_keys), df::YELLOW);
      p_player->setScore(m_keys);
    }
    return 1;
  }
  int draw() override { return DM.drawCh(getPosition(), '@', m_color); }

 private:
  std::uint32_t m_player;
  df::Color m_color;
  int m_keys = 0;
};

/// Gives each player a ship, and removes it when they leave.
class Harbour : public df::Object {
 public:
  Harbour() {
    setType("Harbour");
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::LEAVE_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::JOIN_EVENT) {
      new Ship(*WM.getPlayer(dynamic_cast<const df::EventJoin*>(p_e)->getPlayer()));
      return 1;
    }
    if (p_e->getType() == df::LEAVE_EVENT) {
      const df::Player* p_player = WM.getPlayer(dynamic_cast<const df::EventLeave*>(p_e)->getPlayer());
      if (df::Object* p_ship = p_player != nullptr ? p_player->getObject() : nullptr)
        WM.markForDelete(p_ship);
      return 1;
    }
    return 0;
  }
};

}  // namespace

void populateBusyWorld(df::World& world, int count) {
  world.setSeed(7);
  new Harbour;
  for (int i = 0; i < count; ++i) new Creature;
}

}  // namespace naiad::test
