// An Object that sends and receives messages over the published engine's sockets. If the game is a server
// (NetworkManager.h), it gets events when players join and leave; messages to clients are dropped.
#pragma once

#include <string>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventNetwork.h"
#include "Object.h"

namespace df {

/// An unscoped enumeration in the published engine until 4.18; see DF_ENUM in ObjectAttributes.h.
DF_ENUM MessageType{
    UNDEFINED_MESSAGE = -1,    SYNC_OBJECT,    DELETE_OBJECT, GAME_OVER,
    SET_GAME_OVER = GAME_OVER, KEYBOARD_INPUT, MOUSE_INPUT,   CUSTOM_MESSAGE,
};

class NetworkNode : public Object {
 public:
  /// Makes a SPECTRAL Object that is interested in NETWORK_EVENT.
  NetworkNode();

  /// Passes a NETWORK_EVENT to one of the handlers below and returns its result.
  int eventHandler(const Event* p_e) override;
  virtual int handleConnect(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleAccept(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleData(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleClose(const EventNetwork* /*p_e*/) { return 0; }
  virtual Object* createObject(std::string /*object_type*/) { return nullptr; }

  // The functions below return 1; 0 if no player is connected (`sock` -1); -1 if socket `sock` is not
  // connected, if `p_obj` is null, or if the game is not a server. With result 1, the attributes in a
  // SYNC_OBJECT message count as written (Object::isModified).

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
