#include "engine/published/NetworkManager.h"

#include <algorithm>

#include "engine/published/NetworkServer.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"

namespace df {

namespace {

Connections& connections() {
  return World::current().extras().connections;
}

// Once for each world.
int sayInstead(const std::string& what) {
  World& world = World::current();
  bool& said = world.extras().network_said;
  if (!said) world.log().write(what);
  said = true;
  return -1;
}

int refuse(const char* what) {
  return sayInstead(
      std::string("NetworkManager::") + what +
      ": games need no sockets here. The server runs the game, and whoever joins it plays in this world: "
      "handle EventKeyboard and EventMouse (getPlayer() says whose), EventJoin and EventLeave. A game of two "
      "programs is run as its server.");
}

}  // namespace

NetworkManager& NetworkManager::getInstance() {
  static NetworkManager* p_instance = new NetworkManager;
  return *p_instance;
}

int NetworkManager::startUp() {
  return Manager::startUp();
}

int NetworkManager::setServer(bool server, const std::string& /*port*/) {
  World& world = World::current();
  if (!server) {
    NetworkServer::end(world);
    return 0;
  }
  if (!connections().is_server) {
    world.log().write("NetworkManager::setServer: the players that join are this server's connections");
  }
  NetworkServer::begin(world);
  return 0;
}

bool NetworkManager::isServer() const {
  return connections().is_server && !World::current().isDrawing();
}

int NetworkManager::accept() {
  return connections().is_server ? -1 : refuse("accept");
}

int NetworkManager::connect(const std::string& /*host*/, const std::string& /*port*/) {
  return refuse("connect");
}

int NetworkManager::send(const void* /*buffer*/, int /*bytes*/, int sock) {
  if (!connections().is_server) return refuse("send");
  sayInstead(
      "NetworkManager: messages that the game's two programs have made up between them go nowhere: there is "
      "no client program here, and players send keys and mouse alone");
  return sock < 0 || isConnected(sock) ? 0 : -1;
}

int NetworkManager::receive(void* /*buffer*/, int /*bytes*/, bool /*leave*/, int /*sock*/) {
  return connections().is_server ? -1 : refuse("receive");
}

int NetworkManager::close(int sock) {
  return connections().is_server ? NetworkServer::close(World::current(), sock) : refuse("close");
}

int NetworkManager::setDelay(int /*new_delay*/, int /*sock*/) {
  return connections().is_server ? 0 : refuse("setDelay");
}

bool NetworkManager::isConnected(int sock) const {
  return sock < 0 ? connections().count() > 0 : connections().isConnected(sock);
}

void NetworkManager::setMaxConnections(int new_max_sock) {
  connections().limit = std::max(0, new_max_sock);
}

int NetworkManager::getMaxConnections() const {
  return connections().limit;
}

int NetworkManager::getNumConnections() const {
  return connections().count();
}

int NetworkManager::getSocket(int index) const {
  const Connections& c = connections();
  for (int socket = 0; socket < static_cast<int>(c.players.size()); ++socket) {
    if (c.isConnected(socket) && index-- == 0) return socket;
  }
  return -1;
}

}  // namespace df
