// The kinds of events of the published engine's sockets. The engine sends only those for players that join,
// leave, press keys or use the mouse, and only to games that are servers (NetworkManager.h). The build makes
// a header for each class, such as EventNetworkSync.h. EventNetwork.h does not include these, so that games
// may have event classes of these names.
#pragma once

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventNetwork.h"
#include "Object.h"

namespace df {

inline const EventType NETWORK_ACCEPT_EVENT("df-network-accept");

class EventNetworkAccept : public EventNetwork {
 public:
  explicit EventNetworkAccept(NetworkEventLabel label = NetworkEventLabel::ACCEPT) : EventNetwork(label) {
    setType(NETWORK_ACCEPT_EVENT);
  }
};

inline const EventType NETWORK_CONNECT_EVENT("df-network-connect");

class EventNetworkConnect : public EventNetwork {
 public:
  explicit EventNetworkConnect(NetworkEventLabel label = NetworkEventLabel::CONNECT) : EventNetwork(label) {
    setType(NETWORK_CONNECT_EVENT);
  }
};

inline const EventType NETWORK_CLOSE_EVENT("df-network-close");

class EventNetworkClose : public EventNetwork {
 public:
  explicit EventNetworkClose(NetworkEventLabel label = NetworkEventLabel::CLOSE) : EventNetwork(label) {
    setType(NETWORK_CLOSE_EVENT);
  }
};

inline const EventType NETWORK_CREATE_EVENT("df-network-create");

class EventNetworkCreate : public EventNetwork {
 public:
  explicit EventNetworkCreate(NetworkEventLabel label, Object* p_o = nullptr)
      : EventNetwork(label), m_p_o(p_o) {
    setType(NETWORK_CREATE_EVENT);
  }

  void setObject(Object* p_new_o) { m_p_o = p_new_o; }
  Object* getObject() const { return m_p_o; }

 private:
  Object* m_p_o;
};

inline const EventType NETWORK_DELETE_EVENT("df-network-delete");

class EventNetworkDelete : public EventNetwork {
 public:
  explicit EventNetworkDelete(NetworkEventLabel label, Object* p_o = nullptr)
      : EventNetwork(label), m_p_o(p_o) {
    setType(NETWORK_DELETE_EVENT);
  }

  void setObject(Object* p_new_o) { m_p_o = p_new_o; }
  Object* getObject() const { return m_p_o; }

 private:
  Object* m_p_o;
};

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

inline const EventType NETWORK_GAME_OVER_EVENT("df-network-game-over");

class EventNetworkGameOver : public EventNetwork {
 public:
  explicit EventNetworkGameOver(NetworkEventLabel label = NetworkEventLabel::DATA) : EventNetwork(label) {
    setType(NETWORK_GAME_OVER_EVENT);
  }
};

inline const EventType NETWORK_CUSTOM_EVENT("df-custom-network");

class EventNetworkCustom : public EventNetwork {
 public:
  explicit EventNetworkCustom(NetworkEventLabel label = NetworkEventLabel::DATA) : EventNetwork(label) {
    setType(NETWORK_CUSTOM_EVENT);
  }

  /// The message. Not owned.
  void setMessage(const void* new_message) { m_p_message = new_message; }
  const void* getMessage() const { return m_p_message; }

 private:
  const void* m_p_message = nullptr;
};

/// Name of EventNetworkCustom in versions 4.5 to 4.18 of the published engine.
using EventCustomNetwork = EventNetworkCustom;

// Input of players that are a server's connections, as a client program would have sent it
// (NetworkManager.h).

inline const EventType NETWORK_KEYBOARD_EVENT("df-keyboard-network");

class EventKeyboardNetwork : public EventKeyboard {
 public:
  EventKeyboardNetwork() { setType(NETWORK_KEYBOARD_EVENT); }

  void setSocket(int new_sock) { m_sock = new_sock; }
  int getSocket() const { return m_sock; }
  void setSocketIndex(int new_socket_index) { m_sock = new_socket_index; }
  int getSocketIndex() const { return m_sock; }

 private:
  int m_sock = -1;
};

inline const EventType NETWORK_MSE_EVENT("df-mouse-network");
/// Older name of the type.
inline const EventType NETWORK_MOUSE_EVENT("df-mouse-network");

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
