// The published engine's sockets, which Naiad games need not have: a game is one program, on the server, and
// whoever joins plays in its world. Input of all players comes as EventKeyboard and EventMouse, with
// getPlayer(); who comes and goes, as EventJoin and EventLeave; what Objects look like, everybody sees.
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

  // Nobody is connected.

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
