#include "engine/published/NetworkServer.h"

#include "engine/managers/Config.h"
#include "engine/published/EventNetworks.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Interests.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

bool isThere(const std::vector<Player*>& players, std::uint32_t id) {
  return std::any_of(players.begin(), players.end(), [id](const Player* p) { return p->getId() == id; });
}

// Games of later versions register for the event's own type, those of earlier ones for the common type. Both
// count during a pause, too.
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

// Return whether it ends here. What no Object takes from the network is the local event that it was: so a key
// to leave works in a game that is played with the mouse. But a server that plays has local events of its own
// player alone.
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

}  // namespace

void NetworkServer::begin(World& world) {
  world.extras().connections.is_server = true;
  world.extras().input_filter = [&world](const Event* p_event) { return filter(world, p_event); };
}

void NetworkServer::end(World& world) {
  const int limit = world.extras().connections.limit;
  world.extras().connections = {};
  world.extras().connections.limit = limit;
  world.extras().input_filter = nullptr;
}

bool NetworkServer::filter(World& world, const Event* p_event) {
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

// Handlers may close connections, and end it all.
void NetworkServer::accept(World& world) {
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

void NetworkServer::drop(World& world, int socket) {
  Connections& c = world.extras().connections;
  if (!c.isConnected(socket)) return;
  c.players[static_cast<std::size_t>(socket)] = 0;
  send<EventNetworkClose>(world, NetworkEventLabel::CLOSE, socket);
}

int NetworkServer::close(World& world, int socket) {
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

}  // namespace df
