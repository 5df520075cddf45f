// A maze of 700 walls: the first player to find the exit wins. Then a new maze begins. Example for: a world
// larger than the view, hundreds of Objects that change in one tick, steps as declared controls.
#include <algorithm>
#include <array>
#include <cmath>

#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "WorldManager.h"
using namespace df;

namespace {

// Numbers of rooms. A tile is a room, or a wall or passage between two, and two characters wide. There are
// 2·rows+1 by 2·columns+1 tiles. The rooms and the passages (one fewer) are free; the other 700 are walls.
constexpr int kColumns = 24;
constexpr int kRows = 13;
constexpr int kTileColumns = 2 * kColumns + 1;
constexpr int kTileRows = 2 * kRows + 1;
constexpr int kResultTicks = 60;

Vector place(int column, int row) {
  return {2 * column + 0.5, static_cast<double>(row)};
}

struct Wall : Object {
  Wall(int column, int row) {
    setType("Wall");
    setPosition(place(column, row));
    setBox(Box(Vector(-0.9, -0.4), 1.8, 0.8));
    setStaticLook();
  }
  int draw() override { return DM.drawString(getPosition() - Vector(0.5, 0), "##", LEFT_JUSTIFIED, BLUE); }
};

struct Exit : Object {
  Exit(int column, int row) {
    setType("Exit");
    setSolidness(SOFT);
    setPosition(place(column, row));
    setBox(Box(Vector(-0.9, -0.4), 1.8, 0.8));
    setStaticLook();
  }
  int draw() override { return DM.drawString(getPosition() - Vector(0.5, 0), "<>", LEFT_JUSTIFIED, YELLOW); }
};

struct Walker : Object {
  const std::uint32_t player;
  const Color color;
  bool arrived = false;

  explicit Walker(Player& its) : player(its.getId()), color(its.getColor()) {
    setType("Walker");
    setAltitude(3);
    setBox(Box(Vector(-0.9, -0.4), 1.8, 0.8));
    setPosition(place(1, 1));
    its.setObject(this);
    Controls controls;
    const auto step = [&controls](Keyboard::Key key, int x, int y) {
      for (const auto action : {KEY_PRESSED, KEY_DOWN}) controls.onKey(key, action).step(2 * x, y).every(3);
    };
    for (const auto key : {Keyboard::LEFTARROW, Keyboard::A}) step(key, -1, 0);
    for (const auto key : {Keyboard::RIGHTARROW, Keyboard::D}) step(key, 1, 0);
    for (const auto key : {Keyboard::UPARROW, Keyboard::W}) step(key, 0, -1);
    for (const auto key : {Keyboard::DOWNARROW, Keyboard::S}) step(key, 0, 1);
    its.setControls(controls);
  }
  int eventHandler(const Event* p_e) override {
    const auto* p_collision = dynamic_cast<const EventCollision*>(p_e);
    if (p_collision == nullptr) return 0;
    const bool moves = p_collision->getObject1() == this;
    Object* p_other = moves ? p_collision->getObject2() : p_collision->getObject1();
    if (p_other->getType() == "Exit") arrived = true;
    if (p_other->getType() == "Walker" && moves) {  // so that players in a narrow passage can pass each other
      const Vector mine = getPosition();
      setPosition(p_other->getPosition());
      p_other->setPosition(mine);
    }
    return 1;
  }
  int draw() override { return DM.drawString(getPosition() - Vector(0.5, 0), "()", LEFT_JUSTIFIED, color); }
};

/// Builds the mazes, and makes a walker for each new player.
struct Builder : Object {
  std::array<std::array<bool, kTileColumns>, kTileRows> open{};
  const Exit* p_exit = nullptr;
  int wait = 0;  // ticks until the next maze, after a player has reached the exit
  std::string winner;

  Builder() {
    setSolidness(SPECTRAL);
    for (const auto& type : {JOIN_EVENT, LEAVE_EVENT, STEP_EVENT}) registerInterest(type);
    WM.setBoundary(Box(Vector(0, -1), 2 * kTileColumns, kTileRows + 1));  // one more row, for the texts
    build();
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_join = dynamic_cast<const EventJoin*>(p_e)) new Walker(*WM.getPlayer(p_join->getPlayer()));
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    if (p_e->getType() == STEP_EVENT) step();
    return 1;
  }
  /// Opens passages from this room to all rooms that have none yet, in random directions.
  void dig(int column, int row) {
    open[row][column] = true;
    std::array<std::pair<int, int>, 4> ways = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    for (int i = 3; i > 0; --i) std::swap(ways[i], ways[WM.randomInt(i + 1)]);
    for (const auto& [x, y] : ways) {
      const int next_column = column + 2 * x;
      const int next_row = row + 2 * y;
      if (next_column < 0 || next_column >= kTileColumns || next_row < 0 || next_row >= kTileRows) continue;
      if (open[next_row][next_column]) continue;
      open[row + y][column + x] = true;
      dig(next_column, next_row);
    }
  }
  void build() {
    open = {};
    dig(1, 1);
    for (int row = 0; row < kTileRows; ++row)
      for (int column = 0; column < kTileColumns; ++column)
        if (!open[row][column]) new Wall(column, row);
    p_exit = new Exit(kTileColumns - 2, kTileRows - 2);
  }
  void step() {
    for (Player* p_player : WM.getPlayers()) {
      const auto* p_walker = static_cast<const Walker*>(p_player->getObject());
      if (wait == 0 && p_walker != nullptr && p_walker->arrived) {
        p_player->setScore(p_player->getScore() + 1);
        winner = p_player->getName();
        wait = kResultTicks;
      }
      p_player->setText(0, Vector(1, 0), "mazes won " + std::to_string(p_player->getScore()),
                        p_player->getColor());
      p_player->setText(1, Vector(30, 0), wait > 0 ? winner + " has found the exit!" : "", YELLOW);
      p_player->setText(2, Vector(56, 0), p_walker != nullptr ? compass(*p_walker) : "", YELLOW);
    }
    if (wait == 0 || --wait > 0) return;
    for (const char* type : {"Wall", "Exit", "Walker"}) WM.markForDelete(WM.objectsOfType(type));
    build();
    for (Player* p_player : WM.getPlayers()) new Walker(*p_player);
  }
  std::string compass(const Walker& walker) const {
    const Vector way = p_exit->getPosition() - walker.getPosition();
    return "exit: " + std::to_string(std::lround(way.x() / 2)) + " east, " +
           std::to_string(std::lround(way.y())) + " south";
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Maze: find the exit <> before the others do.", "", "arrows or WASD   walk"});
  new Builder;
  GM.run();
  GM.shutDown();
  return 0;
}
