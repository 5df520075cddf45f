#include "engine/published/NetworkManager.h"

#include <algorithm>

#include "engine/events/Event.h"
#include "engine/managers/Config.h"
#include "engine/published/EventNetworks.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Interests.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"

namespace df {

namespace {

bool isThere(const std::vector<Player*>& players, std::uint32_t id) {
  return std::any_of(players.begin(), players.end(), [id](const Player* p) { return p->getId() == id; });
}

// Sends the event twice, even during a pause: with its own type, for games of later versions of the published
// engine, and with the common type NETWORK_EVENT, for games of earlier versions.
template <class Specific>
void send(World& world, NetworkEventLabel label, int socket) {
  Specific specific(label);
  specific.setSocket(socket);
  world.events().sendToAll(specific);
  EventNetwork common(label);
  common.setSocket(socket);
  world.events().sendToAll(common);
}

EventKeyboardNetwork fromNetwork(const EventKeyboard& key) {
  EventKeyboardNetwork event;
  event.setKey(key.getKey());
  event.setKeyboardAction(key.getKeyboardAction());
  event.setPlayer(key.getPlayer());
  return event;
}

EventMouseNetwork fromNetwork(const EventMouse& mouse) {
  EventMouseNetwork event;
  event.setMouseAction(mouse.getMouseAction());
  event.setMouseButton(mouse.getMouseButton());
  event.setMousePosition(mouse.getMousePosition());
  event.setPlayer(mouse.getPlayer());
  return event;
}

// Sends the input of a connected player as a network event. Returns true if the input must not be sent as a
// local event, too: if an Object got the network event, or if the server is a player itself and the input is
// another player's. So if a game's Objects are interested only in the network events of the mouse, keys still
// work as local events.
template <class Local>
bool handOn(World& world, const Local& local) {
  const Connections& c = world.extras().connections;
  const std::uint32_t player = local.getPlayer();
  const bool is_foreign = c.has_host && player != c.host;
  const int socket = c.socketOf(player);
  if (socket < 0) return is_foreign;
  auto event = fromNetwork(local);
  event.setSocket(socket);
  return world.events().onEvent(&event) > 0 || is_foreign;
}

/// Plays the server's half of a game that was written as two programs, a server and a client for each player,
/// over the published engine's NetworkManager. The players of the world are the connections: a new player is
/// accepted as a socket, and their keys and mouse come as the events that a client program would have sent.
/// Messages that the server sends are dropped, because all players see the server's world.
///
/// If the server is a player itself, with keys that no client has, df-config.txt must have
/// `server_plays:true,`. Then the first player plays as the server and is not a connection.
class NetworkServer {
 public:
  /// Makes this world's players connections, until end().
  static void begin(World& world) {
    world.extras().connections.is_server = true;
    world.extras().input_filter = [&world](const Event* p_event) { return filter(world, p_event); };
  }
  static void end(World& world) {
    const int limit = world.extras().connections.limit;
    world.extras().connections = {};
    world.extras().connections.limit = limit;
    world.extras().input_filter = nullptr;
  }
  /// Closes a connection, or all connections if `socket` is -1. Its player stays in the world and watches.
  /// Returns 0, or -1 if `socket` is not connected.
  static int close(World& world, int socket) {
    Connections& c = world.extras().connections;
    if (socket >= 0 && !c.isConnected(socket)) return -1;
    const int first = socket >= 0 ? socket : 0;
    const int last = socket >= 0 ? socket : static_cast<int>(c.players.size()) - 1;
    for (int i = first; i <= last; ++i) {
      if (!c.isConnected(i)) continue;
      c.closed.push_back(c.players[static_cast<std::size_t>(i)]);
      drop(world, i);
    }
    return 0;
  }

 private:
  static bool filter(World& world, const Event* p_event) {
    if (p_event == nullptr) {
      accept(world);
    } else if (const auto* p_key = dynamic_cast<const EventKeyboard*>(p_event)) {
      return handOn(world, *p_key);
    } else if (const auto* p_mouse = dynamic_cast<const EventMouse*>(p_event)) {
      return handOn(world, *p_mouse);
    } else if (const auto* p_leave = dynamic_cast<const EventLeave*>(p_event)) {
      drop(world, world.extras().connections.socketOf(p_leave->getPlayer()));
    }
    return false;
  }
  static void accept(World& world) {
    // Handlers of the events below may close connections or end the server, so each step checks again.
    Connections& c = world.extras().connections;
    const std::vector<Player*> there = world.views().getPlayers();
    std::erase_if(c.closed, [&there](std::uint32_t id) { return !isThere(there, id); });
    std::vector<std::uint32_t> newcomers;
    for (const Player* p_player : there) {
      const std::uint32_t id = p_player->getId();
      if (c.socketOf(id) < 0 && std::find(c.closed.begin(), c.closed.end(), id) == c.closed.end()) {
        newcomers.push_back(id);
      }
    }
    const std::string plays = Config::getInstance().match("server_plays");
    c.has_host = plays == "true" || plays == "1";
    if (c.has_host) {
      if (!isThere(there, c.host)) c.host = newcomers.empty() ? 0 : newcomers.front();
      std::erase(newcomers, c.host);
    }
    for (const std::uint32_t id : newcomers) {
      if (!c.is_server || c.count() >= c.limit) return;
      int socket = 0;
      while (c.isConnected(socket)) ++socket;
      if (socket == static_cast<int>(c.players.size())) c.players.push_back(0);
      c.players[static_cast<std::size_t>(socket)] = id;
      send<EventNetworkAccept>(world, NetworkEventLabel::ACCEPT, socket);
    }
  }
  static void drop(World& world, int socket) {
    Connections& c = world.extras().connections;
    if (!c.isConnected(socket)) return;
    c.players[static_cast<std::size_t>(socket)] = 0;
    send<EventNetworkClose>(world, NetworkEventLabel::CLOSE, socket);
  }
};

Connections& connections() {
  return World::current().extras().connections;
}

// Logs the line `what` about an unsupported call. Logs only the first such line of each world. Returns -1.
int logUnsupportedOnce(const std::string& what) {
  World& world = World::current();
  bool& said = world.extras().network_logged;
  if (!said) world.log().write(what);
  said = true;
  return -1;
}

int refuse(const char* what) {
  return logUnsupportedOnce(
      std::string("NetworkManager::") + what +
      ": games need no sockets here. The server runs the game, and all players join this world: handle "
      "EventKeyboard and EventMouse (getPlayer() returns the player), EventJoin and EventLeave. Of a game of "
      "two programs, run only the server.");
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
    world.log().write("NetworkManager::setServer: players that join are this server's connections");
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
  logUnsupportedOnce(
      "NetworkManager: the game's own messages are not sent, because there is no client program; players "
      "send only keys and mouse");
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
