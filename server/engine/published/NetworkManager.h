// The published engine's sockets, which Naiad games do not need: a game is one program, on the server, and
// all players play in its world. Input of all players comes as EventKeyboard and EventMouse, with
// getPlayer(); joins and leaves come as EventJoin and EventLeave; the server sends all players what Objects
// look like.
//
// The class exists so that games compile. Its calls fail, and the first one says so in the log.
#pragma once

#include <string>

#include "Manager.h"
#include "NetworkNode.h"
#include "StandardHeaders.h"

#define NM df::NetworkManager::getInstance()

namespace df {

const std::string DRAGONFLY_PORT = "9876";

class NetworkManager : public Manager {
 public:
  static NetworkManager& getInstance();

  /// -1, all of them.
  int startUp() override;
  int setServer(bool server = true, const std::string& port = DRAGONFLY_PORT);
  int accept();
  int connect(const std::string& host, const std::string& port = DRAGONFLY_PORT);
  int send(const void* buffer, int bytes, int sock = -1);
  int receive(void* buffer, int bytes, bool leave, int sock = 0);
  int close(int sock = -1);
  int closeAll() { return close(); }
  int setDelay(int new_delay, int sock = 0);

  // There are no connections.

  bool isServer() const { return false; }
  bool isConnected(int /*sock*/ = -1) const { return false; }
  void setMaxConnections(int new_max_sock) { m_max_connections = new_max_sock; }
  int getMaxConnections() const { return m_max_connections; }
  int getNumConnections() const { return 0; }
  int getSocket(int /*index*/ = 0) const { return -1; }
  int isData(int /*sock*/ = 0) const { return 0; }
  int isAnyData() const { return -1; }
  int genDataEvents(int /*sock*/ = 0) const { return 0; }

 private:
  NetworkManager() { setType("NetworkManager"); }

  int m_max_connections = 1;
};

}  // namespace df
