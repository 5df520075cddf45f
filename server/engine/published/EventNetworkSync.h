// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"
#include "Object.h"

namespace df {

inline const EventType NETWORK_SYNC_EVENT("df-network-sync");

class EventNetworkSync : public EventNetwork {
 public:
  explicit EventNetworkSync(NetworkEventLabel label, Object* p_o = nullptr)
      : EventNetwork(label), m_p_o(p_o) {
    setType(NETWORK_SYNC_EVENT);
  }

  void setObject(Object* p_new_o) { m_p_o = p_new_o; }
  Object* getObject() const { return m_p_o; }

 private:
  Object* m_p_o;
};

}  // namespace df
