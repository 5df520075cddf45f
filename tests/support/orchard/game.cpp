// A game for two players that uses Dragonfly's published network classes: one source, two programs. The
// server has the world, a hand for each client, and their points. A client connects, sends its mouse and
// keys, and draws what the server synchronizes. The two hands pick apples.
//
//     orchard server
//     orchard client HOST

#include <cstdlib>

#include "DisplayManager.h"
#include "EventKeyboardNetwork.h"
#include "EventMouse.h"
#include "EventMouseNetwork.h"
#include "EventNetwork.h"
#include "EventStep.h"
#include "EventView.h"
#include "GameManager.h"
#include "LogManager.h"
#include "NetworkManager.h"
#include "NetworkNode.h"
#include "ViewObject.h"
#include "WorldManager.h"

namespace orchard {

const int PLAYERS = 2;

class Apple : public df::Object {
 public:
  explicit Apple(df::Vector where) {
    setType("Apple");
    setSolidness(df::SOFT);
    setPosition(where);
  }
  int draw() override { return DM.drawCh(getPosition(), 'o', df::RED); }
};

class Points : public df::ViewObject {
 public:
  explicit Points(int sock) {
    setType("Points");
    setLocation(sock == 0 ? df::TOP_LEFT : df::TOP_RIGHT);
    setViewString("Player " + std::to_string(sock));
  }
};

class Hand : public df::Object {
 public:
  explicit Hand(int sock) : m_sock(sock) {
    setType("Hand");
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(20 + 40 * sock, 12));
    if (NM.isServer()) {
      registerInterest(df::NETWORK_MSE_EVENT);
      registerInterest(df::NETWORK_KEYBOARD_EVENT);
    }
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::NETWORK_MSE_EVENT) {
      const df::EventMouseNetwork* p_mouse = dynamic_cast<const df::EventMouseNetwork*>(p_e);
      if (p_mouse->getSocketIndex() != m_sock) return 0;
      setPosition(p_mouse->getMousePosition());
      pick();
      return 1;
    }
    if (p_e->getType() == df::NETWORK_KEYBOARD_EVENT) {
      const df::EventKeyboardNetwork* p_key = dynamic_cast<const df::EventKeyboardNetwork*>(p_e);
      if (p_key->getSocket() == m_sock && p_key->getKey() == df::Keyboard::SPACE)
        setPosition(df::Vector(40, 12));
      return 1;
    }
    return 0;
  }
  // The server draws nothing.
  int draw() override {
    return NM.isServer() ? 0 : DM.drawCh(getPosition(), m_sock == 0 ? 'A' : 'B', df::CYAN);
  }

 private:
  void pick() {
    df::ObjectList apples = WM.objectsOfType("Apple");
    for (int i = 0; i < apples.getCount(); i++) {
      if (df::distance(apples[i]->getPosition(), getPosition()) > 1) continue;
      WM.markForDelete(apples[i]);
      df::EventView ev("Player " + std::to_string(m_sock), 10, true);
      WM.onEvent(&ev);
    }
  }

  int m_sock;
};

class Server : public df::NetworkNode {
 public:
  Server() {
    setType("Server");
    if (NM.setServer(true) != 0) {
      LM.writeLog("Server: cannot be a server");
      exit(-1);
    }
    NM.setMaxConnections(PLAYERS);
    registerInterest(df::STEP_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::STEP_EVENT && NM.isConnected()) return synchronise();
    return NetworkNode::eventHandler(p_e);
  }
  int handleAccept(const df::EventNetwork* p_e) override {
    NM.setDelay(2, p_e->getSocketIndex());
    const std::string name = "PLAYER " + std::to_string(p_e->getSocketIndex());
    if (sendMessage(df::MessageType::CUSTOM_MESSAGE, (int)name.size() + 1, name.c_str(),
                    p_e->getSocketIndex()) == -1) {
      exit(-1);
    }
    if (NM.getNumConnections() < PLAYERS || WM.objectsOfType("Hand").getCount() > 0) return 1;
    for (int i = 0; i < PLAYERS; i++) {
      new Hand(i);
      new Points(i);
    }
    for (int x = 10; x < 80; x += 10) new Apple(df::Vector(x, 6));
    return 1;
  }
  int handleClose(const df::EventNetwork*) override {
    GM.setGameOver();
    return 1;
  }

 private:
  int synchronise() {
    df::ObjectList all = WM.getAllObjects();
    for (int i = 0; i < all.getCount(); i++) {
      if (all[i] == this || !all[i]->isModified(df::ObjectAttribute::POSITION)) continue;
      if (sendMessage(df::MessageType::SYNC_OBJECT, all[i], -1) == -1) exit(-1);
    }
    return 1;
  }
};

class Client : public df::NetworkNode {
 public:
  explicit Client(std::string host) {
    setType("Client");
    NM.setServer(false);
    registerInterest(df::MSE_EVENT);
    if (NM.connect(host) < 0) GM.setGameOver();
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::MSE_EVENT) {
      const df::EventMouse* p_mouse = dynamic_cast<const df::EventMouse*>(p_e);
      return sendMessage(df::MessageType::MOUSE_INPUT, p_mouse->getMouseAction(), p_mouse->getMouseButton(),
                         p_mouse->getMousePosition());
    }
    return NetworkNode::eventHandler(p_e);
  }
  df::Object* createObject(std::string type) override {
    return type == "Apple" ? new Apple(df::Vector()) : NULL;
  }
};

}  // namespace orchard

int main(int argc, char* argv[]) {
  if (GM.startUp() != 0) return 1;
  if (argc > 2) {
    new orchard::Client(argv[2]);
  } else {
    new orchard::Server;
  }
  GM.run();
  GM.shutDown();
  return 0;
}
