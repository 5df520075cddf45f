// The published engine's sockets, which Naiad games do not need: a game is one program, on the server, and
// all players play in its world. Their input comes as EventKeyboard and EventMouse, with getPlayer(); joins
// and leaves come as EventJoin and EventLeave; the server sends all players what Objects look like.
//
// Of a game that was written as two programs only the server's half runs: after setServer() each player that
// joins is a connection. EventNetworkAccept reports it, with a socket (0, 1, …), and EventNetworkClose when
// they leave. Their keys and mouse come as EventKeyboardNetwork and EventMouseNetwork with that socket, or as
// EventKeyboard and EventMouse if no Object is interested in the former. Messages to clients count as sent
// and are dropped. The client's half has nothing to do: connect() fails, with a line in the log.
// docs/bring-your-game.md has the details.
#pragma once

#include <string>

#include "Manager.h"
#include "StandardHeaders.h"

#define NM df::NetworkManager::getInstance()

namespace df {

const std::string DRAGONFLY_PORT = "9876";

class NetworkManager : public Manager {
 public:
  static NetworkManager& getInstance();

  /// Returns 0.
  int startUp() override;
  /// Makes the players connections; false ends that. The host's option --port decides the port. Returns 0.
  int setServer(bool server = true, const std::string& port = DRAGONFLY_PORT);
  /// True if the game is a server. False while Objects draw, because players must see a client's picture.
  bool isServer() const;
  /// Returns -1: players are accepted automatically.
  int accept();
  /// Returns -1.
  int connect(const std::string& host, const std::string& port = DRAGONFLY_PORT);
  /// Drops the message. Returns 0 on the server if the socket is connected or -1 (all sockets), else -1.
  int send(const void* buffer, int bytes, int sock = -1);
  int sendNow(const void* buffer, int bytes, int sock = 0) { return send(buffer, bytes, sock); }
  int sendDelayed() { return 0; }
  /// Returns -1: players send only keys and mouse.
  int receive(void* buffer, int bytes, bool leave, int sock = 0);
  /// Closes a connection, or all connections for -1. Its player stays and watches. Returns 0, else -1.
  int close(int sock = -1);
  int closeAll() { return close(); }
  /// Has no effect. Returns 0 on the server, else -1.
  int setDelay(int new_delay, int sock = 0);

  /// True if a player is connected with this socket or, for -1, with any socket.
  bool isConnected(int sock = -1) const;
  /// Maximum number of connections; further players only watch. Default: 16.
  void setMaxConnections(int new_max_sock);
  int getMaxConnections() const;
  int getNumConnections() const;
  /// Returns the socket of the connection with this index; -1 if unknown.
  int getSocket(int index = 0) const;
  /// Return that no data has arrived.
  int isData(int /*sock*/ = 0) const { return 0; }
  int isAnyData() const { return -1; }
  int genDataEvents(int /*sock*/ = 0) const { return 0; }

 private:
  NetworkManager() { setType("NetworkManager"); }
};

}  // namespace df
