// A lobby: each room of the server is a door with its name, game and number of players. A player that walks
// into a door moves to its room. Example for: the list of rooms, and moving a player to another room.
#include <algorithm>

#include "Controls.h"
#include "DisplayManager.h"
#include "EventCollision.h"
#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "GameRooms.h"
#include "WorldManager.h"
using namespace df;

namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 24;
constexpr int kDoorsInRow = 4;
constexpr int kDoorWidth = kWidth / kDoorsInRow;
constexpr int kDoorHeight = 5;
constexpr int kFirstDoor = 6;                  // row of the first door
constexpr int kPatience = 60;                  // ticks after which a door that did not open is tried again
constexpr std::size_t kSign = kDoorWidth - 2;  // characters of a line of the sign

struct Door : Object {
  const std::size_t number;  // index in the server's list of rooms

  Door(std::size_t room, int place) : number(room) {
    setType("Door");
    setSolidness(SOFT);
    setAltitude(1);
    setBox(Box(Vector(-1.5, -0.4), 3, 0.8));
    const int row = place / kDoorsInRow;
    setPosition(Vector(kDoorWidth * (place % kDoorsInRow + 0.5), kFirstDoor + kDoorHeight * row));
  }
  int draw() override {
    const GameRoom& room = GameRooms().getRooms()[number];
    const Vector at = getPosition();
    const std::string places = std::to_string(room.players) + "/" + std::to_string(room.max_players);
    const bool is_full = room.players >= room.max_players;
    DM.drawString(at - Vector(0, 2), room.name.substr(0, kSign), CENTER_JUSTIFIED, YELLOW);
    DM.drawString(at - Vector(0, 1), room.game.substr(0, kSign - places.size() - 1) + " " + places,
                  CENTER_JUSTIFIED, room.players > 0 ? GREEN : CYAN);
    return DM.drawString(at, is_full ? "[XX]" : "[  ]", CENTER_JUSTIFIED, is_full ? RED : WHITE);
  }
};

struct Walker : Object {
  const std::uint32_t player;
  const Color color;
  int wait = 0;  // ticks until a door may be tried again

  Walker(Player& its, const Box& floor) : player(its.getId()), color(its.getColor()) {
    setType("Walker");
    setSolidness(SOFT);  // so that players at a door do not block each other
    setAltitude(3);
    setBox(Box(Vector(-0.4, -0.4), 0.8, 0.8));
    setPosition(Vector(kWidth / 2.0 + WM.randomInt(11) - 5, 2));
    registerInterest(STEP_EVENT);
    its.setObject(this);
    Controls controls;
    const auto step = [&controls](Keyboard::Key key, int x, int y) {
      for (const auto action : {KEY_PRESSED, KEY_DOWN}) controls.onKey(key, action).step(x, y).every(2);
    };
    for (const auto key : {Keyboard::LEFTARROW, Keyboard::A}) step(key, -1, 0);
    for (const auto key : {Keyboard::RIGHTARROW, Keyboard::D}) step(key, 1, 0);
    for (const auto key : {Keyboard::UPARROW, Keyboard::W}) step(key, 0, -1);
    for (const auto key : {Keyboard::DOWNARROW, Keyboard::S}) step(key, 0, 1);
    its.setControls(controls.within(floor));
  }
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == STEP_EVENT) wait = std::max(wait - 1, 0);
    const auto* p_collision = dynamic_cast<const EventCollision*>(p_e);
    if (p_collision == nullptr) return 0;
    const Object* p_one = p_collision->getObject1();
    const auto* p_door = dynamic_cast<const Door*>(p_one == this ? p_collision->getObject2() : p_one);
    if (p_door != nullptr && wait == 0) enter(*p_door);
    return 1;
  }
  /// Asks the server to move the player. If the server refuses, tells the player why.
  void enter(const Door& door) {
    wait = kPatience;
    GameRooms().send(player, GameRooms().getRooms()[door.number].name);
  }
  int draw() override { return DM.drawCh(getPosition(), '@', color); }
};

/// Builds the doors, and makes a walker for each new player.
struct Porter : Object {
  std::size_t known = 0;  // number of rooms looked at; each but this one has a door
  int doors = 0;

  Porter() {
    setSolidness(SPECTRAL);
    for (const auto& type : {JOIN_EVENT, LEAVE_EVENT, STEP_EVENT}) registerInterest(type);
  }
  int eventHandler(const Event* p_e) override {
    if (auto* p_join = dynamic_cast<const EventJoin*>(p_e))
      new Walker(*WM.getPlayer(p_join->getPlayer()), floor());
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    if (p_e->getType() == STEP_EVENT) build();
    return 1;
  }
  int height() const { return std::max(kHeight, kFirstDoor + kDoorHeight * ((doors - 1) / kDoorsInRow) + 3); }
  Box floor() const { return Box(Vector(1, 2), kWidth - 3, height() - 4); }
  void build() {
    const std::vector<GameRoom>& rooms = GameRooms().getRooms();
    for (; known < rooms.size(); ++known) {
      if (!rooms[known].is_this_one) new Door(known, doors++);
    }
    WM.setBoundary(Box(Vector(0, 0), kWidth, height()));
  }
  int draw() override {
    DM.drawString(Vector(kWidth / 2.0, 0), "Walk into a door to play", CENTER_JUSTIFIED, CYAN);
    if (doors == 0)
      DM.drawString(Vector(kWidth / 2.0, 12), "This server has no other rooms.", CENTER_JUSTIFIED, RED);
    return 0;
  }
};

}  // namespace

int main() {
  GM.startUp();
  GM.setHelp({"Lobby: the doors lead to the games of this server.", "",
              "arrows or WASD   walk; into a door: play there",
              "Ctrl-G r         list of rooms, from anywhere"});
  new Porter;
  GM.run();
  GM.shutDown();
  return 0;
}
