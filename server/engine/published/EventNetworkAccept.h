// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"

namespace df {

inline const EventType NETWORK_ACCEPT_EVENT("df-network-accept");

class EventNetworkAccept : public EventNetwork {
 public:
  explicit EventNetworkAccept(NetworkEventLabel label = NetworkEventLabel::ACCEPT) : EventNetwork(label) {
    setType(NETWORK_ACCEPT_EVENT);
  }
};

}  // namespace df
