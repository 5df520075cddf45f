// Tron: each cycle leaves a wall behind it. Turn in time; the player who rides longest wins the round. A
// single player rides against a robot. Example for: rounds that players can join, many Objects at rest, one
// class for players and robots, best scores that the server stores.
#include <array>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "HighScores.h"
#include "WorldManager.h"
using namespace df;

namespace {

constexpr int kStartTicks = 45;   // ticks before the start, so that players find their cycle
constexpr int kResultTicks = 75;  // ticks for which the result is shown
const Box kBody(Vector(-0.4, -0.4), 0.8, 0.8);
const std::array<Vector, 4> kWays = {Vector(1, 0), Vector(0, 1), Vector(-1, 0), Vector(0, -1)};

/// A piece of a cycle's wall, or of the fence around the field.
struct Wall : Object {
  const Color color;
  const char ch;
  Wall(Vector at, Color its_color, char its_ch) : color(its_color), ch(its_ch) {
    setType(its_ch == '+' ? "Fence" : "Trail");
    setPosition(at);
    setBox(kBody);
    setStaticLook();
  }
  int draw() override { return DM.drawCh(getPosition(), ch, color); }
};

struct Cycle : Object {
  const std::uint32_t player;  // id of the player; 0: a robot
  const std::string name;
  const Color color;
  int way;        // direction, as an index in kWays
  int wish;       // direction of the next move
  int cells = 0;  // number of cells ridden in this round
  bool wrecked = false;

  Cycle(const Player* p, Vector at, int its_way)
      : player(p ? p->getId() : 0),
        name(p ? p->getName() : "the robot"),
        color(p ? p->getColor() : WHITE),
        way(its_way),
        wish(its_way) {
    setType("Cycle");
    setAltitude(3);
    setBox(kBody);
    setPosition(at);
    registerInterest(KEYBOARD_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
    if (!p_key || p_key->getPlayer() != player || p_key->getKeyboardAction() != KEY_PRESSED) return 0;
    switch (p_key->getKey()) {
      case Keyboard::RIGHTARROW:
      case Keyboard::D:
        return turn(0);
      case Keyboard::DOWNARROW:
      case Keyboard::S:
        return turn(1);
      case Keyboard::LEFTARROW:
      case Keyboard::A:
        return turn(2);
      case Keyboard::UPARROW:
      case Keyboard::W:
        return turn(3);
      default:
        return 0;
    }
  }
  int turn(int new_way) {
    if ((new_way + 2) % 4 != way) wish = new_way;  // it must not turn back into its own wall
    return 1;
  }
  /// Returns the number of free cells in this direction, up to `most`.
  int freeCells(int which, int most) const {
    Vector at = getPosition();
    for (int i = 0; i < most; ++i) {
      at = at + kWays[static_cast<std::size_t>(which)];
      if (WM.isCollision(this, at)) return i;
    }
    return most;
  }
  /// Steers a robot: mostly straight on, otherwise to the side with more free cells.
  void think() {
    if (freeCells(way, 2) == 2 && WM.randomInt(25) != 0) return;
    const int left = (way + 3) % 4;
    const int right = (way + 1) % 4;
    const int best = freeCells(left, 12) > freeCells(right, 12) ? left : right;
    if (freeCells(best, 12) > freeCells(way, 4)) wish = best;
  }
  /// Moves one cell and leaves a wall behind. A row is as high as two columns are wide, so a vertical move
  /// takes twice as long.
  void ride(int tick) {
    if (player == 0) think();
    if (tick % 2 != 0 || (wish % 2 == 1 && tick % 4 != 0)) return;
    way = wish;
    const Vector before = getPosition();
    if (WM.moveObject(this, before + kWays[static_cast<std::size_t>(way)]) != 0) {
      wrecked = true;
    } else {
      new Wall(before, color, '#');
      ++cells;
    }
  }
  int draw() override {
    return DM.drawCh(getPosition(), wrecked ? 'X' : ">v<^"[way], wrecked ? WHITE : color);
  }
};

/// Runs the rounds.
struct Track : Object {
  std::vector<Cycle*> cycles;  // cycles of this round
  int wait = 0;                // ticks until the round begins, or until the next round is prepared
  bool riding = false;
  std::string message;
  HighScores rides{"rides"};  // best rides in cells, stored by the server

  Track() {
    setSolidness(SPECTRAL);
    for (const auto& type : {STEP_EVENT, LEAVE_EVENT}) registerInterest(type);
    for (int x = 0; x < 80; ++x)
      for (const int y : {1, 23}) new Wall(Vector(x, y), BLUE, '+');
    for (int y = 2; y < 23; ++y)
      for (const int x : {0, 79}) new Wall(Vector(x, y), BLUE, '+');
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e)) {
      for (Cycle* p_cycle : cycles)
        if (p_cycle->player == p_leave->getPlayer()) p_cycle->wrecked = true;
    }
    if (p_e->getType() == STEP_EVENT) step();
    return 1;
  }
  void step() {
    if (wait > 0) {
      --wait;
    } else if (riding) {
      race();
    } else if (!WM.getPlayers().empty()) {
      prepare();
    }
    const auto best = rides.best(1);
    const std::string longest = best.empty() ? "" : std::to_string(best[0].points) + " " + best[0].name;
    for (Player* p : WM.getPlayers()) {
      const bool rides_now = p->getObject() != nullptr;
      p->setText(2, Vector(54, 0), rides_now && !best.empty() ? "best " + longest : "", CYAN);
      p->setText(0, Vector(1, 0), "rounds won " + std::to_string(p->getScore()), p->getColor());
      p->setText(1, Vector(30, 0), rides_now ? message : message + "   (you ride in the next round)");
    }
  }
  void race() {
    Cycle* p_last = nullptr;
    int left = 0;
    for (Cycle* p_cycle : cycles) {
      if (!p_cycle->wrecked) p_cycle->ride(GM.getStepCount());
      if (p_cycle->wrecked) continue;
      p_last = p_cycle;
      ++left;
    }
    message = std::to_string(left) + " ride";
    if (left > 1) return;
    message = left == 0 ? "nobody wins" : p_last->name + " wins";
    if (left == 1) {
      if (Player* p_winner = WM.getPlayer(p_last->player)) {
        p_winner->setScore(p_winner->getScore() + 1);
        rides.add(p_last->name, p_last->cells);
      }
    }
    riding = false;
    wait = kResultTicks;
  }
  /// Clears the field, and places all players evenly along its left and right sides.
  void prepare() {
    for (const char* type : {"Cycle", "Trail"}) WM.markForDelete(WM.objectsOfType(type));
    cycles.clear();
    const auto players = WM.getPlayers();
    const int count = std::max(2, static_cast<int>(players.size()));
    cycles.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      Player* p = i < static_cast<int>(players.size()) ? players[static_cast<std::size_t>(i)] : nullptr;
      const int row = 3 + (i / 2 * 2 + 1) * 18 / (count + count % 2);
      cycles.push_back(new Cycle(p, Vector(i % 2 == 0 ? 8 : 71, row), i % 2 == 0 ? 0 : 2));
      if (p) p->setObject(cycles.back());
    }
    message = "get ready";
    riding = true;
    wait = kStartTicks;
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Tron: every cycle leaves a wall. Do not ride into any.", "", "arrows or WASD   turn", "",
              "The last one who rides wins the round."});
  new Track;
  GM.run();
  GM.shutDown();
  return 0;
}
