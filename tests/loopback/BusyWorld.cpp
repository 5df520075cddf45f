#include "BusyWorld.h"

#include <string>
#include <vector>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventMouse.h"
#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Controls.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectLookAccess.h"
#include "engine/world/Player.h"
#include "shared/replica/Look.h"

namespace naiad::test {

namespace {

df::Vector somewhere(const BusyScene& scene) {
  const double x = WM.randomInt(scene.width * 100) / 100.0;
  return {x, WM.randomInt(scene.height * 100) / 100.0};
}

df::Vector somehow() {
  const double x = (WM.randomInt(200) - 100) / 120.0;
  return {x, (WM.randomInt(200) - 100) / 240.0};
}

df::Color someColor() {
  return static_cast<df::Color>(1 + WM.randomInt(df::kColorCount - 1));
}

/// Returns one of four letters from `first` on: few, so that clients reach their limit of remembered looks
/// within minutes.
char someLetter(char first) {
  return static_cast<char>(first + WM.randomInt(4));
}

/// Returns frames of seven characters, from a few different sequences.
Sequence someFrames(df::Color color) {
  std::vector<Appearance> frames(static_cast<std::size_t>(2 + WM.randomInt(6)));
  const int letter = WM.randomInt(4);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const auto turned = static_cast<std::int32_t>(k);
    for (std::int32_t i = -3; i <= 3; ++i)
      frames[k].push_back({256 * i, 256 * (i * turned / 3 % 4), static_cast<char32_t>(U'p' + letter), color});
  }
  return Sequence(frames);
}

/// Returns a selector by a clock or by an angle that changes by itself.
Selector somePace(df::World& world) {
  const auto tick = static_cast<std::uint32_t>(world.getStepCount());
  const int kind = WM.randomInt(4);
  const auto ticks = static_cast<std::uint32_t>(1 + WM.randomInt(12));
  if (kind < 2) return Selector::clock(tick, ticks, kind == 0, static_cast<std::size_t>(WM.randomInt(2)));
  return Selector::turning(tick, static_cast<std::uint32_t>(WM.randomInt(4096)) << 20,
                           (WM.randomInt(2001) - 1000) * 100'003);
}

/// One character, a word, a square, or in a rich scene frames that change by themselves.
class Creature : public df::Object {
 public:
  explicit Creature(const BusyScene& scene) : m_scene(scene) {
    setType("Creature");
    setPosition(somewhere(m_scene));
    setVelocity(somehow());
    setAltitude(WM.randomInt(df::MAX_ALTITUDE + 1));
    setSolidness(static_cast<df::Solidness>(WM.randomInt(3)));
    if (WM.randomInt(8) == 0) setAcceleration(df::Vector(0, 0.01));
    m_kind = WM.randomInt(m_scene.is_rich ? 6 : 4);
    if (m_kind == kSquare) setBox(df::Box(df::Vector(-1, -1), side(), side()));
    m_color = someColor();
    if (m_kind > kSquare) {
      setBox(df::Box(df::Vector(-4, -4), 9, 9));
      df::ObjectLookAccess::setFrames(*this, someFrames(m_color), somePace(*getWorld()));
    }
    m_text = std::string(m_kind == 0 ? 1 : 3 + 4 * WM.randomInt(3), someLetter('a'));
    registerInterest(df::STEP_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) {
      setPosition(somewhere(m_scene));
      return 1;
    }
    if (p_e->getType() != df::STEP_EVENT) return 0;
    ++m_age;
    change(WM.randomInt(400));
    return 1;
  }

  int draw() override {
    if (m_kind > kSquare) {
      df::Object::draw();
      return m_kind == 4 || m_age % 64 > 8 ? 0 : DM.drawCh(getPosition(), '!', m_color);  // blinks
    }
    if (m_kind < kSquare) return DM.drawString(getPosition(), m_text, df::LEFT_JUSTIFIED, m_color);
    // A square of even width tests cells at offsets of half a cell, whose positions are converted to floats.
    const double half = (side() - 1) / 2.0;
    for (int i = 0; i < side() * side(); ++i) {
      const int row = i / side();
      const df::Vector at(getPosition().getX() - half + i % side(), getPosition().getY() - half + row);
      DM.drawCh(at, side() == 3 && i == 4 ? "|/-\\"[m_age / 8 % 4] : m_text.front(), m_color);
    }
    return 0;
  }

 private:
  static constexpr int kSquare = 3;

  int side() const { return m_scene.is_rich ? 3 : 2; }
  void change(int what) {
    if (what == 0) setVelocity(somehow());
    if (what == 1) m_text.front() = someLetter('A');
    if (what == 2) setVisible(!isVisible());
    if (what == 3) setPosition(somewhere(m_scene));
    if (what == 4) m_color = someColor();
    if (m_kind > kSquare && what >= 6 && what < 10)
      df::ObjectLookAccess::setSelector(*this, somePace(*getWorld()));
    if (m_kind > kSquare && what == 10)
      df::ObjectLookAccess::setFrames(*this, someFrames(m_color), somePace(*getWorld()));
    if (what == 5) {
      WM.markForDelete(this);
      new Creature(m_scene);
    }
  }

  BusyScene m_scene;
  int m_kind = 0;
  int m_age = 0;
  df::Color m_color = df::WHITE;
  std::string m_text;
};

/// A player's ship.
class Ship : public df::Object {
 public:
  Ship(df::Player& player, const BusyScene& scene) : m_player(player.getId()), m_color(player.getColor()) {
    setType("Ship");
    setPosition(scene.is_rich ? somewhere(scene) : df::Vector(40, 12));
    setSolidness(scene.is_rich && m_player % 4 == 0 ? df::HARD : df::SPECTRAL);
    setAltitude(df::MAX_ALTITUDE);
    player.setObject(this);
    registerInterest(df::KEYBOARD_EVENT);
    if (!scene.is_rich || m_player % 2 != 0) return;
    using namespace df::Keyboard;
    player.setControls(df::Controls()
                           .onKey(LEFTARROW)
                           .drive(-0.5, 0)
                           .onKey(RIGHTARROW)
                           .drive(0.5, 0)
                           .onKey(UPARROW)
                           .step(0, -1)
                           .every(2)
                           .onKey(DOWNARROW)
                           .step(0, 1)
                           .every(2)
                           .within(df::Box(df::Vector(1, 1), scene.width - 2, scene.height - 2)));
  }

  int eventHandler(const df::Event* p_e) override {
    const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_e);
    if (p_key == nullptr || p_key->getPlayer() != m_player) return 0;
    if (p_key->getKeyboardAction() != df::KEY_PRESSED) return 0;
    const df::Keyboard::Key key = p_key->getKey();
    if (!p_key->isHandled()) {
      using namespace df::Keyboard;
      const int across = (key == RIGHTARROW || key == D) - (key == LEFTARROW || key == A);
      const int down = (key == DOWNARROW || key == S) - (key == UPARROW || key == W);
      if (across != 0 || down != 0) WM.moveObject(this, getPosition() + df::Vector(across, down));
    }
    ++m_keys;
    if (df::Player* p_player = WM.getPlayer(m_player)) {
      p_player->setText(0, df::Vector(2, 0), "keys " + std::to_string(m_keys), df::YELLOW);
      const std::string shout = m_keys % 3 == 0 ? std::string() : std::string(5 + m_keys % 40, '*');
      p_player->setText(1, df::Vector(2, 23), shout, m_color);
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

/// Gives each player a ship, removes it when they leave, and counts and reports their events.
class Harbour : public df::Object {
 public:
  Harbour(Census* p_census, const BusyScene& scene) : m_p_census(p_census), m_scene(scene) {
    setType("Harbour");
    setSolidness(df::SPECTRAL);
    setVisible(false);
    for (const std::string& type : {df::JOIN_EVENT, df::LEAVE_EVENT, df::KEYBOARD_EVENT, df::MSE_EVENT})
      registerInterest(type);
  }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_e)) {
      if (m_p_census == nullptr) return 1;
      if (p_key->getKeyboardAction() == df::KEY_PRESSED) ++m_p_census->pressed;
      if (p_key->getKeyboardAction() == df::KEY_RELEASED) ++m_p_census->released;
      report({p_key->getPlayer(), false, p_key->getKey(), p_key->getKeyboardAction()});
    } else if (const auto* p_mouse = dynamic_cast<const df::EventMouse*>(p_e)) {
      report({p_mouse->getPlayer(), true, p_mouse->getMouseButton(), p_mouse->getMouseAction()});
    } else if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e)) {
      new Ship(*WM.getPlayer(p_join->getPlayer()), m_scene);
      if (m_p_census != nullptr) ++m_p_census->joins;
    } else if (const auto* p_leave = dynamic_cast<const df::EventLeave*>(p_e)) {
      const df::Player* p_player = WM.getPlayer(p_leave->getPlayer());
      df::Object* p_ship = p_player != nullptr ? p_player->getObject() : nullptr;
      if (p_ship != nullptr) WM.markForDelete(p_ship);
      if (m_p_census != nullptr) ++m_p_census->leaves;
    }
    return 1;
  }

 private:
  void report(const Heard& heard) {
    if (m_p_census != nullptr && m_p_census->on_heard) m_p_census->on_heard(heard);
  }

  Census* m_p_census;
  BusyScene m_scene;
};

}  // namespace

void populateBusyWorld(df::World& world, int count, Census* p_census, const BusyScene& scene) {
  world.setSeed(scene.seed);
  if (scene.is_rich) WM.setBoundary(df::Box(df::Vector(0, 0), scene.width, scene.height));
  new Harbour(p_census, scene);
  for (int i = 0; i < count; ++i) new Creature(scene);
}

}  // namespace naiad::test
