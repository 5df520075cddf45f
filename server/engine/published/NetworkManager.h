// The published engine's sockets, which Naiad games do not need: a game is one program, on the server, and
// all players play in its world. Input of all players comes as EventKeyboard and EventMouse, with
// getPlayer(); joins and leaves come as EventJoin and EventLeave; the server sends all players what Objects
// look like.
//
// A game that was written as two programs is played by its server's half: after setServer() each player that
// joins is a connection. An EventNetworkAccept says so, with a socket (0, 1, …), and an EventNetworkClose
// when they leave; their keys and mouse come as EventKeyboardNetwork and EventMouseNetwork with that socket,
// or as local events where no Object is interested in those. What is sent to clients counts as sent and goes
// nowhere. The client's half has nothing to do: connect() fails and says so in the log.
// docs/bring-your-game.md has the whole of it.
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

  /// Return 0.
  int startUp() override;
  /// The players are connections from now on; false: no longer. The port is the host's (--port). Return 0.
  int setServer(bool server = true, const std::string& port = DRAGONFLY_PORT);
  /// Is this the server? Not while Objects draw: what they draw is for the players, who see what a client
  /// would show them.
  bool isServer() const;
  /// -1: players are accepted by themselves.
  int accept();
  /// -1.
  int connect(const std::string& host, const std::string& port = DRAGONFLY_PORT);
  /// As the server 0, though nothing receives it; else -1. sendDelayed() has nothing to send.
  int send(const void* buffer, int bytes, int sock = -1);
  int sendNow(const void* buffer, int bytes, int sock = 0) { return send(buffer, bytes, sock); }
  int sendDelayed() { return 0; }
  /// -1: players send keys and mouse and nothing else.
  int receive(void* buffer, int bytes, bool leave, int sock = 0);
  /// The player stays and watches; -1: all of them. Return 0, or -1 if there is no such connection.
  int close(int sock = -1);
  int closeAll() { return close(); }
  /// As the server 0, without effect; else -1.
  int setDelay(int new_delay, int sock = 0);

  /// Is a player connected as this socket; -1: is any?
  bool isConnected(int sock = -1) const;
  /// Players beyond this number watch. 16, if never set.
  void setMaxConnections(int new_max_sock);
  int getMaxConnections() const;
  int getNumConnections() const;
  /// The socket of the connection with this index; -1 if there is none.
  int getSocket(int index = 0) const;
  /// There is never any.
  int isData(int /*sock*/ = 0) const { return 0; }
  int isAnyData() const { return -1; }
  int genDataEvents(int /*sock*/ = 0) const { return 0; }

 private:
  NetworkManager() { setType("NetworkManager"); }
};

}  // namespace df
