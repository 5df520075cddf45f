// Chase: gather the gold and avoid the hounds. They run towards the nearest player; their number grows with
// the gold that was gathered. Example for: joining and leaving, declared controls, collisions, texts for a
// single player.
#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "WorldManager.h"
#include "utility.h"
using namespace df;

namespace {

constexpr int kShieldTicks = 60;  // ticks for which a new hare is protected
constexpr int kAimTicks = 12;     // ticks between two choices of a hound's target
constexpr int kGoldPerHound = 5;  // gold after which there is one more hound
const Box kBody(Vector(-0.4, -0.4), 0.8, 0.8);

/// Returns a random cell. Draws in two steps, as the compiler may evaluate a call's arguments in any order.
Vector dice(int width, int height) {
  const int y = WM.randomInt(height);
  return Vector(WM.randomInt(width), y);
}

/// Returns a random free place below the row of the texts.
Vector anywhere(const Object* p_o) {
  while (true) {
    const Vector place = Vector(1, 2) + dice(78, 21);
    if (!WM.isCollision(p_o, place)) return place;
  }
}

struct Gold : Object {
  Gold() {
    setType("Gold");
    setSolidness(SOFT);
    setBox(kBody);
    setStaticLook();
    setPosition(anywhere(this));
  }
  int draw() override { return DM.drawCh(getPosition(), '$', YELLOW); }
};

/// A player's character.
struct Hare : Object {
  const std::uint32_t player;
  const std::string name;
  const Color color;
  int shield = 0;

  explicit Hare(Player& its) : player(its.getId()), name(its.getName()), color(its.getColor()) {
    setType("Hare");
    setSolidness(SOFT);
    setAltitude(3);
    setBox(kBody);
    registerInterest(STEP_EVENT);
    its.setObject(this);
    // The keys are declared, so that the player's own client shows a step at once. A row is as high as two
    // columns are wide.
    Controls controls;
    for (const auto key : {Keyboard::LEFTARROW, Keyboard::A}) controls.onKey(key).drive(-0.6, 0);
    for (const auto key : {Keyboard::RIGHTARROW, Keyboard::D}) controls.onKey(key).drive(0.6, 0);
    for (const auto key : {Keyboard::UPARROW, Keyboard::W}) controls.onKey(key).drive(0, -0.3);
    for (const auto key : {Keyboard::DOWNARROW, Keyboard::S}) controls.onKey(key).drive(0, 0.3);
    its.setControls(controls.toWholeCells().within(Box(Vector(0, 1), 79, 22)).releaseAfter(40));
    start();
  }
  void start() {
    setPosition(anywhere(this));
    shield = kShieldTicks;
  }
  int eventHandler(const Event* p_e) override {
    Player* p_player = WM.getPlayer(player);
    if (p_player == nullptr) return 0;  // the player leaves in this tick
    if (p_e->getType() == STEP_EVENT && shield > 0) --shield;
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_collision = static_cast<const EventCollision*>(p_e);
      Object* p_other =
          p_collision->getObject1() == this ? p_collision->getObject2() : p_collision->getObject1();
      if (p_other->getType() == "Gold") {
        p_player->setScore(p_player->getScore() + 10);
        p_other->setPosition(anywhere(p_other));
      } else if (p_other->getType() == "Hound" && shield == 0) {
        p_player->setScore(p_player->getScore() / 2);
        start();
      }
    }
    return 1;
  }
  int draw() override {
    if (shield > 0) DM.drawString(getPosition() + Vector(0, -1), name, CENTER_JUSTIFIED, color);
    return DM.drawCh(getPosition(), shield / 4 % 2 == 0 ? '@' : 'o', color);
  }
};

struct Hound : Object {
  Hound() {
    setType("Hound");
    setSolidness(SOFT);
    setBox(kBody);
    setStaticLook();
    const Vector side = dice(2, 22);
    setPosition(Vector(79 * side.x(), 1 + side.y()));
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() != STEP_EVENT || (GM.getStepCount() + getId()) % kAimTicks != 0) return 0;
    const Hare* p_prey = nullptr;
    const ObjectList hares = WM.objectsOfType("Hare");
    for (int i = 0; i < hares.getCount(); ++i) {
      const auto* p_hare = static_cast<const Hare*>(hares[i]);
      if (p_hare->shield > 0) continue;  // hounds ignore a shielded hare
      if (p_prey == nullptr || way(p_hare) < way(p_prey)) p_prey = p_hare;
    }
    // A hound without a target runs in a random direction.
    Vector target = Vector(0, 1) + dice(80, 22);
    if (p_prey != nullptr) target = p_prey->getPosition() + dice(7, 3) - Vector(3, 1);
    Vector direction = target - getPosition();
    direction.normalize();
    direction.scale(0.36);
    setVelocity(Vector(direction.x(), direction.y() / 2));
    return 1;
  }
  double way(const Object* p_o) const { return distance(getPosition(), p_o->getPosition()); }
  int draw() override { return DM.drawCh(getPosition(), 'H', RED); }
};

/// Handles players who join or leave, sends the hounds, and shows the score to all players.
struct Forest : Object {
  Forest() {
    setSolidness(SPECTRAL);
    for (const auto& type : {JOIN_EVENT, LEAVE_EVENT, STEP_EVENT}) registerInterest(type);
    for (int i = 0; i < 12; ++i) new Gold;
    for (int i = 0; i < 3; ++i) new Hound;
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_join = dynamic_cast<const EventJoin*>(p_e)) new Hare(*WM.getPlayer(p_join->getPlayer()));
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    if (p_e->getType() == STEP_EVENT) step();
    return 1;
  }
  void step() {
    int points = 0;
    for (const Player* p_player : WM.getPlayers()) points += p_player->getScore();
    const ObjectList hounds = WM.objectsOfType("Hound");
    const int wanted = std::min(3 + points / (10 * kGoldPerHound), 20);
    if (hounds.getCount() < wanted) new Hound;
    if (hounds.getCount() > wanted) WM.markForDelete(hounds[0]);
    for (Player* p_player : WM.getPlayers()) {
      p_player->setText(0, Vector(1, 0), "gold " + std::to_string(p_player->getScore()),
                        p_player->getColor());
      p_player->setText(1, Vector(68, 0), "hounds " + std::to_string(hounds.getCount()), RED);
    }
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Chase: gather the gold $, keep away from the hounds H.", "", "arrows or WASD   run", "",
              "A hound takes half of your gold. The more is gathered, the more hounds come."});
  new Forest;
  GM.run();
  GM.shutDown();
  return 0;
}
