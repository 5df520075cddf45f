// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"

namespace df {

inline const EventType NETWORK_CLOSE_EVENT("df-network-close");

class EventNetworkClose : public EventNetwork {
 public:
  explicit EventNetworkClose(NetworkEventLabel label = NetworkEventLabel::CLOSE) : EventNetwork(label) {
    setType(NETWORK_CLOSE_EVENT);
  }
};

}  // namespace df
