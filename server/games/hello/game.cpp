// A complete game: each player is an @ and walks with the arrow keys. Walls and other players block it.
#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventPlayer.h"
#include "GameManager.h"
#include "WorldManager.h"
using namespace df;

struct Wall : Object {  // HARD by default, so that it blocks other Objects
  int draw() override { return DM.drawCh(getPosition(), '#', BLUE); }
};

struct Walker : Object {
  const std::uint32_t player;  // id of its player
  const Color color;
  explicit Walker(Player* p_player) : player(p_player->getId()), color(p_player->getColor()) {
    p_player->setObject(this);
    setBox(Box(Vector(-0.4, -0.4), 0.8, 0.8));  // smaller than a cell, so that neighbours do not touch
    do {
      const int y = WM.randomInt(24);  // row first, because compilers evaluate arguments in any order
      setPosition(Vector(WM.randomInt(80), y));
    } while (WM.isCollision(this, getPosition()));
    registerInterest(KEYBOARD_EVENT);
  }
  int eventHandler(const Event* p_e) override {
    const auto* p_key = dynamic_cast<const EventKeyboard*>(p_e);
    if (!p_key || p_key->getPlayer() != player) return 0;  // the key of another player
    if (p_key->getKeyboardAction() == KEY_RELEASED) return 0;
    const int key = p_key->getKey();
    const int x = (key == Keyboard::RIGHTARROW) - (key == Keyboard::LEFTARROW);
    const int y = (key == Keyboard::DOWNARROW) - (key == Keyboard::UPARROW);
    return WM.moveObject(this, getPosition() + Vector(x, y));
  }
  int draw() override { return DM.drawCh(getPosition(), '@', color); }
};

struct Door : Object {  // makes a walker for each player who joins
  Door() { registerInterest(JOIN_EVENT), registerInterest(LEAVE_EVENT); }
  int eventHandler(const Event* p_e) override {
    if (auto* p_join = dynamic_cast<const EventJoin*>(p_e)) new Walker(WM.getPlayer(p_join->getPlayer()));
    if (auto* p_leave = dynamic_cast<const EventLeave*>(p_e))
      WM.markForDelete(WM.getPlayer(p_leave->getPlayer())->getObject());
    return 1;
  }
};

int main() {
  GM.startUp();
  GM.setHelp({"Hello: everybody who joins is an @.", "", "arrows   walk; walls and others block"});
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 24; ++y)
      if (x % 79 == 0 || y % 23 == 0 || (y == 12 && x % 20 > 3)) (new Wall)->setPosition(Vector(x, y));
  new Door;
  GM.run();
  GM.shutDown();
  return 0;
}
