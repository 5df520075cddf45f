// An Object that sends and receives messages over the published engine's sockets. Here it gets events of
// players that come and go, if the game is a server (NetworkManager.h); messages to clients are dropped.
#pragma once

#include <string>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventNetwork.h"
#include "Object.h"

namespace df {

/// Unscoped until 4.18 (ObjectAttributes.h).
DF_ENUM MessageType{
    UNDEFINED_MESSAGE = -1,    SYNC_OBJECT,    DELETE_OBJECT, GAME_OVER,
    SET_GAME_OVER = GAME_OVER, KEYBOARD_INPUT, MOUSE_INPUT,   CUSTOM_MESSAGE,
};

class NetworkNode : public Object {
 public:
  /// Makes it SPECTRAL and interested in NETWORK_EVENT.
  NetworkNode();

  /// Passes a NETWORK_EVENT to one of the handlers below. Returns what that returns.
  int eventHandler(const Event* p_e) override;
  virtual int handleConnect(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleAccept(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleData(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleClose(const EventNetwork* /*p_e*/) { return 0; }
  virtual Object* createObject(std::string /*object_type*/) { return nullptr; }

  // These return 1 on the server, or 0 if no player is connected (-1: if this one is not), and synchronised
  // attributes count as written (Object::isModified). Elsewhere they return -1.

  int sendMessage(MessageType msg_type, int sock = -1);
  int sendMessage(MessageType msg_type, Object* p_obj, unsigned int attr = 0, int sock = -1);
  int sendMessage(MessageType msg_type, Object* p_obj, const std::string& attr, int sock = -1);
  int sendMessage(MessageType msg_type, EventKeyboardAction action, Keyboard::Key key, int sock = -1);
  int sendMessage(MessageType msg_type, EventMouseAction action, Mouse::Button button, Vector mouse_position,
                  int sock = -1);
  int sendMessage(MessageType msg_type, int num_bytes, const void* bytes, int sock = -1);
  int genDataEvents(int /*sock*/ = 0) const { return 0; }

 protected:
  char* m_p_buff = nullptr;
  int m_buff_size = 0;
};

/// Returns "sync-object" and so on. Declared here and not in utility.h, so that games with a NetworkManager
/// and events of their own in this namespace get none of these names unless they include this.
std::string toString(MessageType message);

}  // namespace df
