// Bullet hell: hundreds of bullets at once, and a small ship among them. Its gun fires by itself; the player
// has to survive. Example for: many Objects in straight flight (which need no network traffic), levels,
// lives, friends who fight a boss together.
#include <algorithm>
#include <cmath>

#include "Controls.h"
#include "DisplayManager.h"
#include "Elementary.h"
#include "EventCollision.h"
#include "EventOut.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "WorldManager.h"
#include "utility.h"
using namespace df;

namespace {

constexpr int kShieldTicks = 75;
constexpr int kPatternTicks = 180;  // ticks after which the boss changes its pattern
constexpr int kLives = 3;           // lives at the start of each level
const Box kPoint(Vector(-0.2, -0.2), 0.4, 0.4);

/// A shot of a player or of the boss. It flies straight until it leaves the world.
struct Shot : Object {
  const std::uint32_t player;  // id of the player; 0: the boss's shot
  const char ch;
  const Color color;
  Shot(const char* type, std::uint32_t its_player, Vector at, Vector velocity, char its_ch, Color its_color)
      : player(its_player), ch(its_ch), color(its_color) {
    setType(type);
    setSolidness(SOFT);
    setBox(kPoint);
    setPosition(at);
    setVelocity(velocity);
    setStaticLook();
  }
  int eventHandler(const Event* p_e) override {
    return p_e->getType() == OUT_EVENT ? WM.markForDelete(this) : 0;
  }
  int draw() override { return DM.drawCh(getPosition(), ch, color); }
};

struct Ship : Object {
  const std::uint32_t player;
  const Color color;
  int lives = 0;
  int shield = 0;

  explicit Ship(Player& its) : player(its.getId()), color(its.getColor()) {
    setType("Ship");
    setBox(kPoint);
    setAltitude(3);
    registerInterest(STEP_EVENT);
    its.setObject(this);
    Controls controls;
    for (const auto key : {Keyboard::LEFTARROW, Keyboard::A}) controls.onKey(key).drive(-0.7, 0);
    for (const auto key : {Keyboard::RIGHTARROW, Keyboard::D}) controls.onKey(key).drive(0.7, 0);
    for (const auto key : {Keyboard::UPARROW, Keyboard::W}) controls.onKey(key).drive(0, -0.35);
    for (const auto key : {Keyboard::DOWNARROW, Keyboard::S}) controls.onKey(key).drive(0, 0.35);
    its.setControls(controls.toWholeCells().within(Box(Vector(0, 8), 79, 15)).releaseAfter(40));
    begin(kLives);
  }
  void begin(int new_lives) {
    lives = new_lives;
    shield = kShieldTicks;
    setVisible(lives > 0);
    setSolidness(SPECTRAL);
    setPosition(Vector(20 + WM.randomInt(40), 21));
    if (Player* p_player = WM.getPlayer(player)) p_player->setSteering(lives > 0);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT && lives > 0) {
      if (shield > 0 && --shield == 0) setSolidness(SOFT);
      if (static_cast<const EventStep*>(p_e)->getStepCount() % 6 == 0)
        new Shot("Ours", player, getPosition() + Vector(0, -1), Vector(0, -0.9), '\'', color);
    }
    if (auto* p_collision = dynamic_cast<const EventCollision*>(p_e)) {
      const bool moves = p_collision->getObject1() == this;
      Object* p_other = moves ? p_collision->getObject2() : p_collision->getObject1();
      if (p_other->getType() == "Theirs" && shield == 0) begin(lives - 1);
    }
    return 1;
  }
  int draw() override { return shield / 4 % 2 == 1 ? 0 : DM.drawCh(getPosition(), 'A', color); }
};

struct Boss : Object {
  const int level;
  const int most;
  int life;

  Boss(int its_level, int players) : level(its_level), most((30 + 20 * level) * players), life(most) {
    setType("Boss");
    setSolidness(SOFT);
    setAltitude(3);
    setPosition(Vector(40, 4));
    setBox(Box(Vector(-4, -1), 8, 2));
    setVelocity(Vector(0.2, 0));
    registerInterest(STEP_EVENT);
  }
  /// Shoots at an angle in parts of a whole turn; 0 is down.
  void shoot(double turn, double speed, char ch, Color color) const {
    const double angle = 6.283185307179586 * turn;
    const Vector velocity(speed * math::sin(angle), speed / 2 * math::cos(angle));
    new Shot("Theirs", 0, getPosition() + Vector(0, 1), velocity, ch, color);
  }
  void spiral(int tick) const {
    const int arms = 2 + level;
    if (tick % 2 != 0) return;
    for (int i = 0; i < arms; ++i) shoot(tick / 100.0 + double(i) / arms, 0.35, '*', MAGENTA);
  }
  void rings(int tick) const {
    const int shots = 20 + 4 * level;
    if (tick % 24 != 0) return;
    for (int i = 0; i < shots; ++i) shoot((i + tick / 24 % 2 * 0.5) / shots, 0.3, 'o', CYAN);
  }
  void fans(int tick) const {
    const ObjectList ships = WM.objectsOfType("Ship");
    if (tick % 20 != 0 || ships.isEmpty()) return;
    const Vector way = ships[tick / 20 % ships.getCount()]->getPosition() - getPosition();
    const double turn = math::atan2(way.x(), 2 * way.y()) / 6.283185307179586;
    for (int i = -level - 1; i <= level + 1; ++i) shoot(turn + 0.03 * i, 0.5, '+', YELLOW);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT) {
      const int tick = static_cast<const EventStep*>(p_e)->getStepCount();
      if (std::abs(getPosition().x() - 40) > 25) setVelocity(Vector(getPosition().x() > 40 ? -0.2 : 0.2, 0));
      if (tick / kPatternTicks % 3 == 0) spiral(tick);
      if (tick / kPatternTicks % 3 == 1) rings(tick);
      if (tick / kPatternTicks % 3 == 2) fans(tick);
    }
    if (auto* p_collision = dynamic_cast<const EventCollision*>(p_e)) {
      const bool moves = p_collision->getObject1() == this;
      Object* p_other = moves ? p_collision->getObject2() : p_collision->getObject1();
      if (p_other->getType() != "Ours" || !p_other->isVisible()) return 0;
      p_other->setVisible(false);  // so that the shot hits only once
      WM.markForDelete(p_other);
      --life;
      Player* p_player = WM.getPlayer(static_cast<const Shot*>(p_other)->player);
      if (p_player != nullptr) p_player->setScore(p_player->getScore() + 1);
    }
    return 1;
  }
  int draw() override {
    DM.drawString(getPosition() + Vector(-3, 0), "/-\\_/-\\", LEFT_JUSTIFIED, RED);
    return DM.drawString(getPosition() + Vector(-3, 1), "\\_(O)_/", LEFT_JUSTIFIED, RED);
  }
};

/// Makes a ship for each player, and a boss for each level.
struct Arena : Object {
  Boss* p_boss = nullptr;
  std::string message;
  int message_ticks = 0;

  Arena() {
    setSolidness(SPECTRAL);
    for (const auto& type : {JOIN_EVENT, LEAVE_EVENT, STEP_EVENT}) registerInterest(type);
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_join = dynamic_cast<const EventJoin*>(p_e)) new Ship(*WM.getPlayer(p_join->getPlayer()));
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    if (p_e->getType() == STEP_EVENT) step();
    return 1;
  }
  void step() {
    const ObjectList ships = WM.objectsOfType("Ship");
    int lives = 0;
    for (int i = 0; i < ships.getCount(); ++i) lives += static_cast<const Ship*>(ships[i])->lives;
    if (ships.isEmpty()) return;
    --message_ticks;
    if (p_boss == nullptr) begin(1, "");
    if (p_boss->life <= 0)
      begin(p_boss->level + 1, "The boss is beaten! Level " + std::to_string(p_boss->level + 1));
    if (lives == 0) begin(1, "All ships are lost. Level 1");
    const int bar = 40 * std::max(p_boss->life, 0) / p_boss->most;
    for (Player* p : WM.getPlayers()) {
      const auto* p_ship = static_cast<const Ship*>(p->getObject());
      const std::string lives_left = std::to_string(p_ship != nullptr ? p_ship->lives : 0);
      const std::string status = "hits " + std::to_string(p->getScore()) + "  lives " + lives_left;
      p->setText(0, Vector(1, 0), status, p->getColor());
      p->setText(1, Vector(25, 0), std::string(static_cast<std::size_t>(bar), '#'), RED);
      p->setText(2, Vector(68, 0), "level " + std::to_string(p_boss->level), YELLOW);
      p->setText(3, Vector(25, 23), message_ticks > 0 ? message : "", YELLOW);
    }
  }
  void begin(int level, const std::string& why) {
    message = why;
    message_ticks = 90;
    if (p_boss != nullptr) WM.markForDelete(p_boss);
    WM.markForDelete(WM.objectsOfType("Theirs"));
    p_boss = new Boss(level, static_cast<int>(WM.getPlayers().size()));
    const ObjectList ships = WM.objectsOfType("Ship");
    for (int i = 0; i < ships.getCount(); ++i) static_cast<Ship*>(ships[i])->begin(kLives);
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Bullet hell: keep out of the way of the bullets until the boss is beaten.", "",
              "arrows or WASD   fly", "", "The gun fires by itself. Three lives in each level."});
  new Arena;
  GM.run();
  GM.shutDown();
  return 0;
}
