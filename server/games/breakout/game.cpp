// Breakout for four: each player guards a side, and the bricks are in the middle. Unguarded sides are walls,
// so a single player has the classic game. Example for: a limited number of places with a queue, fast Objects
// (setSwept), bouncing, levels.
#include <array>
#include <cmath>

#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventOut.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "WorldManager.h"
using namespace df;

namespace {

constexpr int kServeTicks = 30;  // ticks for which a ball rests on its paddle before it is served
constexpr double kTouch = 1e-3;  // cells: boxes whose distance is smaller are about to touch
constexpr std::array kColors = {RED, MAGENTA, YELLOW, GREEN, CYAN, WHITE};
enum Side { BOTTOM, TOP, LEFT, RIGHT };

struct Brick : Object {
  const Color color;
  Brick(Vector at, Color its_color) : color(its_color) {
    setType("Brick");
    setPosition(at);
    setBox(Box(Vector(-1.9, -0.4), 3.8, 0.8));
    setStaticLook();
  }
  int draw() override { return DM.drawString(getPosition() - Vector(1.5, 0), "[##]", LEFT_JUSTIFIED, color); }
};

/// What closes a side of the court: a wall, or a player's paddle.
struct Guard : Object {
  const Side side;
  const std::uint32_t player;  // id of the player; 0: a wall
  const Color color;
  int width, height;

  Guard(Side where, Player* p) : side(where), player(p ? p->getId() : 0), color(p ? p->getColor() : BLUE) {
    setType(p ? "Paddle" : "Wall");
    const bool lies = side == BOTTOM || side == TOP;
    width = !lies ? 1 : p ? 11 : 80;
    height = lies ? 1 : p ? 7 : 23;
    setPosition(std::array{Vector(39.5, 23), Vector(39.5, 1), Vector(0, 12), Vector(79, 12)}[side]);
    setBox(Box(Vector(-width / 2.0 + 0.1, -height / 2.0 + 0.1), width - 0.2, height - 0.2));
    if (p) obey(*p);
  }
  void obey(Player& its) {
    setPosition(Vector(std::floor(getPosition().x()), getPosition().y()));
    its.setObject(this);
    Controls controls;
    using namespace Keyboard;
    const bool lies = width > height;
    const Vector way = lies ? Vector(1.2, 0) : Vector(0, 0.6);
    const auto back = lies ? std::array{LEFTARROW, A} : std::array{UPARROW, W};
    const auto forth = lies ? std::array{RIGHTARROW, D} : std::array{DOWNARROW, S};
    for (const auto key : back) controls.onKey(key).drive(-way.x(), -way.y());
    for (const auto key : forth) controls.onKey(key).drive(way.x(), way.y());
    its.setControls(controls.toWholeCells().within(Box(Vector(5, 1), 69, 22)).releaseAfter(40));
  }
  /// Returns the direction from the middle of this side into the court.
  Vector inward() const { return std::array{Vector(0, -1), Vector(0, 1), Vector(1, 0), Vector(-1, 0)}[side]; }
  int draw() override {
    const Vector corner = getPosition() - Vector((width - 1) / 2.0, (height - 1) / 2.0);
    for (int i = 0; i < width * height; ++i)
      DM.drawCh(corner + (width > height ? Vector(i, 0) : Vector(0, i)), player ? '=' : '#', color);
    return 0;
  }
};

/// A player's ball. It has the colour of the paddle that hit it last, whose player gets its points.
struct Ball : Object {
  const std::uint32_t home;
  std::uint32_t shooter;
  Color color;
  int rest = kServeTicks;
  double speed = 0.8;

  explicit Ball(const Player& player) : home(player.getId()), shooter(home), color(player.getColor()) {
    setType("Ball");
    setBox(Box(Vector(-0.3, -0.3), 0.6, 0.6));
    setSwept();  // so that it hits everything on its path, not only at the end of the path
    setAltitude(3);
    registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT && rest > 0) waitOnPaddle();
    if (p_e->getType() == OUT_EVENT) lose();
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_collision = static_cast<const EventCollision*>(p_e);
      const bool moves = p_collision->getObject1() == this;
      bounce(*(moves ? p_collision->getObject2() : p_collision->getObject1()),
             moves ? p_collision->getPosition() : getPosition());
    }
    return 1;
  }
  void waitOnPaddle() {
    const Player* p_player = WM.getPlayer(home);
    const auto* p_paddle = static_cast<const Guard*>(p_player ? p_player->getObject() : nullptr);
    if (p_paddle == nullptr) return;  // the player leaves in this tick
    setPosition(p_paddle->getPosition() + p_paddle->inward());
    shooter = home;
    color = p_paddle->color;
    if (--rest > 0) return;
    const Vector in = p_paddle->inward();
    const double aside = 0.3 + 0.1 * WM.randomInt(5);
    go(in.x() == 0 ? Vector(aside, in.y()) : Vector(in.x(), aside));
  }
  /// Starts to move in this direction. A row is as high as two columns are wide.
  void go(Vector direction) {
    direction.normalize();
    direction.scale(speed);
    setVelocity(Vector(direction.x(), direction.y() / 2));
  }
  void bounce(Object& other, Vector at) {
    const Box box = other.getBox();
    const Vector half(box.getHorizontal() / 2, box.getVertical() / 2);
    const Vector off = at - (other.getPosition() + box.getCorner() + half);
    const bool beside = std::abs(off.x()) > half.x() + 0.3 - kTouch;
    const bool above = std::abs(off.y()) > half.y() + 0.3 - kTouch;
    double x = getVelocity().x();
    double y = getVelocity().y() * 2;
    if (beside) x = std::copysign(x, off.x());
    if (above || !beside) y = std::copysign(y, off.y());
    if (other.getType() == "Paddle") {  // the point of the paddle that was hit decides the direction
      const auto& guard = static_cast<const Guard&>(other);
      shooter = guard.player;
      color = guard.color;
      if (guard.width > guard.height) x = 0.12 * off.x() * speed + 0.1 * x;
      if (guard.width < guard.height) y = 0.3 * off.y() * speed + 0.1 * y;
    } else if (other.getType() == "Brick") {
      other.setActive(false);  // so that no other ball hits it in this tick
      WM.markForDelete(&other);
      earn(10);
    }
    if (std::abs(y) < 0.1) y = y < 0 ? -0.1 : 0.1;  // never quite horizontal: it would never come down
    go(Vector(x, y));
  }
  void earn(int points) const {
    if (Player* p = WM.getPlayer(shooter)) p->setScore(std::max(0, p->getScore() + points));
  }
  void lose() {
    const Vector at = getPosition();
    const Side side = at.y() > 23 ? BOTTOM : at.y() < 1 ? TOP : at.x() < 40 ? LEFT : RIGHT;
    const ObjectList paddles = WM.objectsOfType("Paddle");
    for (int i = 0; i < paddles.getCount(); ++i) {
      const auto* p_paddle = static_cast<const Guard*>(paddles[i]);
      if (p_paddle->side == side) shooter = p_paddle->player;  // the player of this side loses points
    }
    earn(-10);
    rest = kServeTicks;
    setVelocity(Vector());
  }
  int draw() override { return DM.drawCh(getPosition(), 'O', color); }
};

/// Gives sides to players, and makes the bricks of the level.
struct Court : Object {
  std::array<Guard*, 4> guards{};
  int level = 0;

  Court() {
    setSolidness(SPECTRAL);
    for (const auto& type : {STEP_EVENT, LEAVE_EVENT}) registerInterest(type);
    for (const Side side : {BOTTOM, TOP, LEFT, RIGHT}) guards[side] = new Guard(side, nullptr);
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e)) leave(p_leave->getPlayer());
    if (p_e->getType() == STEP_EVENT) step();
    return 1;
  }
  void close(Side side, Player* p_player) {
    WM.markForDelete(guards[side]);
    guards[side]->setActive(false);
    guards[side] = new Guard(side, p_player);
  }
  void leave(std::uint32_t player) {
    for (const Side side : {BOTTOM, TOP, LEFT, RIGHT})
      if (guards[side]->player == player) close(side, nullptr);
    const ObjectList balls = WM.objectsOfType("Ball");
    for (int i = 0; i < balls.getCount(); ++i)
      if (static_cast<const Ball*>(balls[i])->home == player) WM.markForDelete(balls[i]);
  }
  void step() {
    for (Player* p : WM.getPlayers()) {
      for (const Side side : {BOTTOM, TOP, LEFT, RIGHT}) {
        if (p->getObject() != nullptr || guards[side]->player != 0) continue;
        close(side, p);
        new Ball(*p);
      }
      p->setText(0, Vector(1, 0), "points " + std::to_string(p->getScore()), p->getColor());
      p->setText(1, Vector(34, 0), "level " + std::to_string(level), YELLOW);
      p->setText(2, Vector(50, 0), p->getObject() ? "" : "all sides are taken: wait");
    }
    if (WM.objectsOfType("Brick").isEmpty()) build();
  }
  void build() {
    ++level;
    for (int row = 0; row < static_cast<int>(kColors.size()); ++row)
      for (int column = 0; column < 9; ++column)
        new Brick(Vector(23.5 + 4 * column, 9 + row), kColors[static_cast<std::size_t>(row)]);
    const ObjectList balls = WM.objectsOfType("Ball");
    for (int i = 0; i < balls.getCount(); ++i) {  // serve all of them again, a little faster
      auto* p_ball = static_cast<Ball*>(balls[i]);
      p_ball->rest = kServeTicks;
      p_ball->setVelocity(Vector());
      p_ball->speed = std::min(0.7 + 0.1 * level, 1.5);
    }
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Breakout for four: guard your side, break the bricks.", "", "arrows or WASD   move the paddle",
              "", "A brick earns 10 points, a ball that gets past you costs 10."});
  new Court;
  GM.run();
  GM.shutDown();
  return 0;
}
