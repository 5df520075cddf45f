// Plays the server's half of a game that was written as two programs, a server and a client for each player,
// over the published engine's NetworkManager. The players of the world are the connections: who joins is
// accepted as a socket, and their keys and mouse come as the events that a client program would have sent.
// What the server sends goes nowhere, for all players see the server's world.
//
// A game whose server is a player itself (it has keys of its own, one client has the others) says
// `server_plays:true,` in df-config.txt: then the first player sits at the server and is no connection.
#pragma once

#include "engine/events/Event.h"
#include "engine/world/World.h"

namespace df {

class NetworkServer {
 public:
  /// From now on this world's players are connections; or no longer.
  static void begin(World& world);
  static void end(World& world);
  /// Close a connection; the player stays and watches. -1: all of them. Return 0, or -1 for none.
  static int close(World& world, int socket);

 private:
  static bool filter(World& world, const Event* p_event);
  static void accept(World& world);
  static void drop(World& world, int socket);
};

}  // namespace df
