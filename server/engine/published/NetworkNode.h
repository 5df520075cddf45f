// The published engine's end of a socket: an Object that sends and receives messages. Here it hears of
// players that come and go, if the game is a server (NetworkManager.h); messages to clients go nowhere.
#pragma once

#include <string>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventNetwork.h"
#include "Object.h"

namespace df {

/// Plain until 4.18 (ObjectAttributes.h).
DF_ENUM MessageType{
    UNDEFINED_MESSAGE = -1,    SYNC_OBJECT,    DELETE_OBJECT, GAME_OVER,
    SET_GAME_OVER = GAME_OVER, KEYBOARD_INPUT, MOUSE_INPUT,   CUSTOM_MESSAGE,
};

class NetworkNode : public Object {
 public:
  /// SPECTRAL, interested in NETWORK_EVENT.
  NetworkNode();

  /// Hand a NETWORK_EVENT to one of those below. Return what it does.
  int eventHandler(const Event* p_e) override;
  virtual int handleConnect(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleAccept(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleData(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleClose(const EventNetwork* /*p_e*/) { return 0; }
  virtual Object* createObject(std::string /*object_type*/) { return nullptr; }

  // As the server: 1, or 0 if no player is connected (-1: if this one is not); what is synchronised counts as
  // written (Object::isModified). Else -1.

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

/// "sync-object" and so on. Declared here and not in utility.h, so that games that bring a NetworkManager and
/// its events of their own, in this namespace, meet none of these unless they ask for them.
std::string toString(MessageType message);

}  // namespace df
