// A platformer: run and jump to the flag. Friends are solid: stand on each other's heads to reach high
// places. Example for: a world larger than the view, gravity as an acceleration, swept moves that land
// exactly, a level drawn in text.
#include <algorithm>
#include <array>
#include <cmath>

#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventKeyboard.h"
#include "EventOut.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "WorldManager.h"
using namespace df;

namespace {

constexpr double kRun = 0.5;  // cells per tick
constexpr double kJump = 0.72;
constexpr double kGravity = 0.055;  // cells per tick²: a jump is almost six rows high and 14 columns long
constexpr int kCoinTicks = 450;     // ticks after which a coin that was taken reappears

// # is ground, o a coin, ^ spikes, F the flag. The first row is row kTop of the world.
constexpr std::array kLevel = {
    "                                                                                                    ",
    "                                                                            o                       ",
    "                                                 o   o                    #####                     ",
    "                                                 #####                              o               ",
    "                       o                  o                          o            ####              ",
    "                     #####               ###                       #####                            ",
    "                                                                                                    ",
    "                            o                           o                                        F  ",
    "           o               ####     o                  ###      o                           ########",
    "         #####      o             #####      #####            #####                         ########",
    "                                                                                      ##############",
    "                                                                                      ##############",
    "      o            ^^^                  ^         o              ^^         o   ####################",
    "##################################   #######   ########   ###########   ############################",
    "##################################   #######   ########   ###########   ############################",
};
constexpr int kTop = 7;
const double kRows = 24;
const double kColumns = 100;

struct Ground : Object {  // one Object for several # side by side
  const int length;
  Ground(int x, int y, int its_length) : length(its_length) {
    setType("Ground");
    setPosition(Vector(x, y));
    setBox(Box(Vector(-0.5, -0.5), length, 1));
    setStaticLook();
  }
  int draw() override {
    return DM.drawString(getPosition(), std::string(length, '#'), LEFT_JUSTIFIED, GREEN);
  }
};

/// A coin, spikes or the flag: an Object that acts when it is touched.
struct Thing : Object {
  const char ch;
  int gone = 0;  // ticks until the coin reappears
  Thing(int x, int y, char its_ch) : ch(its_ch) {
    setType(ch == 'o' ? "Coin" : ch == '^' ? "Spikes" : "Flag");
    setPosition(Vector(x, y));
    setBox(Box(Vector(-0.4, -0.4), 0.8, 0.9));
    setSolidness(SOFT);
    if (ch == 'o') registerInterest(STEP_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT && gone > 0 && --gone == 0) take(0);
    return 1;
  }
  void take(int ticks) {
    gone = ticks;
    setVisible(gone == 0);
    setSolidness(gone == 0 ? SOFT : SPECTRAL);
  }
  int draw() override { return DM.drawCh(getPosition(), ch, ch == 'o' ? YELLOW : ch == '^' ? RED : MAGENTA); }
};

struct Runner : Object {
  const std::uint32_t player;
  const Color color;
  bool beside = false;  // a wall stopped the runner in this tick
  bool done = false;    // the runner is at the flag or in the spikes
  int age = 0;          // ticks since it was made

  explicit Runner(Player& its) : player(its.getId()), color(its.getColor()) {
    setType("Runner");
    setBox(Box(Vector(-0.4, -0.45), 0.8, 0.9));
    setSwept();  // so that it lands on the ground, not a little above the ground
    setAltitude(3);
    for (const auto& type : {STEP_EVENT, KEYBOARD_EVENT}) registerInterest(type);
    its.setObject(this);
    Controls controls;  // keys control running; the event handler does jumps, which need ground
    for (const auto key : {Keyboard::LEFTARROW, Keyboard::A}) controls.onKey(key).drive(-kRun, 0);
    for (const auto key : {Keyboard::RIGHTARROW, Keyboard::D}) controls.onKey(key).drive(kRun, 0);
    its.setControls(controls.within(Box(Vector(0, -100), kColumns - 1, 300)).releaseAfter(40));
    start();
  }
  void start() {
    setPosition(*WM.findFree(getBox(), Vector(2, 20)));
    setVelocity(Vector());
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT) step();
    if (p_e->getType() == OUT_EVENT) start();
    if (auto* p_key = dynamic_cast<const EventKeyboard*>(p_e); p_key && p_key->getPlayer() == player) {
      const auto key = p_key->getKey();
      const bool jumps = key == Keyboard::SPACE || key == Keyboard::UPARROW || key == Keyboard::W;
      if (jumps && p_key->getKeyboardAction() != KEY_RELEASED && stands()) fall(-kJump);
    }
    if (auto* p_collision = dynamic_cast<const EventCollision*>(p_e)) {
      const bool moves = p_collision->getObject1() == this;
      Object* p_other = moves ? p_collision->getObject2() : p_collision->getObject1();
      if (p_other->getSolidness() == HARD && moves) stopAt(*p_other, p_collision->getPosition());
      if (p_other->getSolidness() == SOFT) touch(*static_cast<Thing*>(p_other));
    }
    return 1;
  }
  void fall(double speed) { setVelocity(Vector(getVelocity().x(), speed)); }
  bool stands() const {
    const ObjectList below = WM.getCollisions(this, getPosition() + Vector(0, 0.01));
    for (int i = 0; i < below.getCount(); ++i)
      if (below[i]->getSolidness() == HARD) return getVelocity().y() >= 0;
    return false;
  }
  void step() {
    Player* p_player = WM.getPlayer(player);
    if (++age == 60 && p_player != nullptr)
      p_player->setText(1, Vector(), "");  // removes the message about the last runner
    const bool standing = stands();
    if (standing && getVelocity().y() != 0) fall(0);
    const Vector pull(0, standing ? 0 : kGravity);
    if (getAcceleration() != pull) setAcceleration(pull);
    // A runner that is stopped by a wall still falls or rises.
    if (std::exchange(beside, false) && !standing)
      WM.moveObject(this, getPosition() + Vector(0, getVelocity().y()));
  }
  void stopAt(const Object& other, Vector at) {
    const Box box = other.getBox();
    const double top = other.getPosition().y() + box.getCorner().y();
    const bool above = at.y() + 0.449 < top || at.y() - 0.449 > top + box.getVertical();
    if (above)
      fall(0);
    else
      beside = true;
  }
  void touch(Thing& thing) {
    Player* p_player = WM.getPlayer(player);
    if (p_player == nullptr || done) return;
    if (thing.ch == 'o') thing.take(kCoinTicks);
    if (thing.ch != '^') p_player->setScore(p_player->getScore() + (thing.ch == 'F' ? 100 : 10));
    if (thing.ch == 'F') p_player->setText(1, Vector(30, 0), "You have reached the flag!", MAGENTA);
    if (thing.ch == '^') p_player->setText(1, Vector(30, 0), "Ouch. Mind the spikes.", RED);
    done = thing.ch != 'o';
    if (done) WM.markForDelete(this);  // Land then makes another runner
  }
  int draw() override { return DM.drawCh(getPosition(), '@', color); }
};

/// Makes the level, and a runner for each new player.
struct Land : Object {
  Land() {
    setSolidness(SPECTRAL);
    for (const auto& type : {STEP_EVENT, LEAVE_EVENT}) registerInterest(type);
    WM.setBoundary(Box(Vector(), kColumns, kRows));
    for (int row = 0; row < static_cast<int>(kLevel.size()); ++row) {
      const std::string line = kLevel[static_cast<std::size_t>(row)];
      for (std::size_t x = 0; x < line.size(); ++x) {
        if (line[x] != ' ' && line[x] != '#') new Thing(static_cast<int>(x), row + kTop, line[x]);
        if (line[x] != '#') continue;
        const std::size_t end = std::min(line.find_first_not_of('#', x), line.size());
        new Ground(static_cast<int>(x), row + kTop, static_cast<int>(end - x));
        x = end - 1;
      }
    }
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    if (p_e->getType() != STEP_EVENT) return 0;
    for (Player* p : WM.getPlayers()) {
      if (p->getObject() == nullptr) new Runner(*p);
      p->setText(0, Vector(1, 0), "points " + std::to_string(p->getScore()), p->getColor());
    }
    return 1;
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Run and jump to the flag.", "", "arrows left, right, or A, D   run",
              "space, up, W                  jump", "",
              "A coin is worth 10 points, the flag 100. You can stand on others."});
  new Land;
  GM.run();
  GM.shutDown();
  return 0;
}
