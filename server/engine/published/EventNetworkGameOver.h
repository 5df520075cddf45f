// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"

namespace df {

inline const EventType NETWORK_GAME_OVER_EVENT("df-network-game-over");

class EventNetworkGameOver : public EventNetwork {
 public:
  explicit EventNetworkGameOver(NetworkEventLabel label = NetworkEventLabel::DATA) : EventNetwork(label) {
    setType(NETWORK_GAME_OVER_EVENT);
  }
};

}  // namespace df
