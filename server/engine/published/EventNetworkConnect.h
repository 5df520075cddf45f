// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"

namespace df {

inline const EventType NETWORK_CONNECT_EVENT("df-network-connect");

class EventNetworkConnect : public EventNetwork {
 public:
  explicit EventNetworkConnect(NetworkEventLabel label = NetworkEventLabel::CONNECT) : EventNetwork(label) {
    setType(NETWORK_CONNECT_EVENT);
  }
};

}  // namespace df
