#include "engine/published/NetworkManager.h"

#include "engine/published/NetworkNode.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

// Once for each world.
static int sayInstead(const char* what) {
  World& world = World::current();
  bool& said = world.extras().network_said;
  if (!said) {
    world.log(
        std::string(what) +
        ": games need no sockets here. The server runs the game, and whoever joins it plays in this world: "
        "handle EventKeyboard and EventMouse (getPlayer() says whose), EventJoin and EventLeave.");
  }
  said = true;
  return -1;
}

NetworkManager& NetworkManager::getInstance() {
  static NetworkManager* p_instance = new NetworkManager;
  return *p_instance;
}

int NetworkManager::startUp() {
  return sayInstead("NetworkManager::startUp");
}

int NetworkManager::setServer(bool /*server*/, const std::string& /*port*/) {
  return sayInstead("NetworkManager::setServer");
}

int NetworkManager::accept() {
  return sayInstead("NetworkManager::accept");
}

int NetworkManager::connect(const std::string& /*host*/, const std::string& /*port*/) {
  return sayInstead("NetworkManager::connect");
}

int NetworkManager::send(const void* /*buffer*/, int /*bytes*/, int /*sock*/) {
  return sayInstead("NetworkManager::send");
}

int NetworkManager::receive(void* /*buffer*/, int /*bytes*/, bool /*leave*/, int /*sock*/) {
  return sayInstead("NetworkManager::receive");
}

int NetworkManager::close(int /*sock*/) {
  return sayInstead("NetworkManager::close");
}

int NetworkManager::setDelay(int /*new_delay*/, int /*sock*/) {
  return sayInstead("NetworkManager::setDelay");
}

int NetworkNode::refuse() {
  return sayInstead("NetworkNode::sendMessage");
}

}  // namespace df
