// An event of the published engine's sockets; nobody sends it (NetworkManager.h).
#pragma once

#include "EventNetwork.h"

namespace df {

inline const EventType NETWORK_CUSTOM_EVENT("df-custom-network");

class EventNetworkCustom : public EventNetwork {
 public:
  explicit EventNetworkCustom(NetworkEventLabel label = NetworkEventLabel::DATA) : EventNetwork(label) {
    setType(NETWORK_CUSTOM_EVENT);
  }

  /// Not owned.
  void setMessage(const void* new_message) { m_p_message = new_message; }
  const void* getMessage() const { return m_p_message; }

 private:
  const void* m_p_message = nullptr;
};

}  // namespace df
