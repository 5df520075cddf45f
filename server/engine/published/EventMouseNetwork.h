// An event of the published engine's sockets; nobody sends it (NetworkManager.h). Here all players' input
// comes as EventMouse, whose getPlayer() says whose it is.
#pragma once

#include "EventMouse.h"

namespace df {

inline const EventType NETWORK_MSE_EVENT("df-mouse-network");

class EventMouseNetwork : public EventMouse {
 public:
  EventMouseNetwork() { setType(NETWORK_MSE_EVENT); }

  void setSocket(int new_sock) { m_sock = new_sock; }
  int getSocket() const { return m_sock; }
  void setSocketIndex(int new_socket_index) { m_sock = new_socket_index; }
  int getSocketIndex() const { return m_sock; }

 private:
  int m_sock = -1;
};

}  // namespace df
