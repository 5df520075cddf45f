// The published engine's end of a socket: an Object that sends and receives messages. It exists so that games
// compile; nothing is sent (NetworkManager.h says what to use instead).
#pragma once

#include <string>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventNetwork.h"
#include "Object.h"

namespace df {

enum class MessageType {
  UNDEFINED_MESSAGE = -1,
  SYNC_OBJECT,
  DELETE_OBJECT,
  GAME_OVER,
  SET_GAME_OVER = GAME_OVER,
  KEYBOARD_INPUT,
  MOUSE_INPUT,
  CUSTOM_MESSAGE,
};

class NetworkNode : public Object {
 public:
  NetworkNode() {
    Object::setType("NetworkNode");
    Object::setSolidness(SPECTRAL);
  }

  int eventHandler(const Event* /*p_e*/) override { return 0; }
  virtual int handleConnect(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleAccept(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleData(const EventNetwork* /*p_e*/) { return 0; }
  virtual int handleClose(const EventNetwork* /*p_e*/) { return 0; }
  virtual Object* createObject(std::string /*object_type*/) { return nullptr; }

  // -1, all of them.

  int sendMessage(MessageType /*msg_type*/, int /*sock*/ = -1) { return refuse(); }
  int sendMessage(MessageType /*msg_type*/, Object* /*p_obj*/, unsigned int /*attr*/ = 0, int /*sock*/ = -1) {
    return refuse();
  }
  int sendMessage(MessageType /*msg_type*/, Object* /*p_obj*/, const std::string& /*attr*/,
                  int /*sock*/ = -1) {
    return refuse();
  }
  int sendMessage(MessageType /*msg_type*/, EventKeyboardAction /*action*/, Keyboard::Key /*key*/,
                  int /*sock*/ = -1) {
    return refuse();
  }
  int sendMessage(MessageType /*msg_type*/, EventMouseAction /*action*/, Mouse::Button /*button*/,
                  Vector /*mouse_position*/, int /*sock*/ = -1) {
    return refuse();
  }
  int sendMessage(MessageType /*msg_type*/, int /*num_bytes*/, const void* /*bytes*/, int /*sock*/ = -1) {
    return refuse();
  }
  int genDataEvents(int /*sock*/ = 0) const { return 0; }

 protected:
  char* m_p_buff = nullptr;
  int m_buff_size = 0;

 private:
  static int refuse();
};

/// "sync-object" and so on. Declared here and not in utility.h, so that games that bring a NetworkManager and
/// its events of their own, in this namespace, meet none of these unless they ask for them.
std::string toString(MessageType message);

}  // namespace df
