#include "engine/published/NetworkNode.h"

#include <sstream>

#include "engine/published/NetworkManager.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

// Returns the result of sendMessage(). If the game is not a server, lets NetworkManager log the reason.
int reach(int sock) {
  if (!World::current().extras().connections.is_server) return NM.send(nullptr, 0, sock);
  if (sock >= 0) return NM.isConnected(sock) ? 1 : -1;
  return NM.isConnected() ? 1 : 0;
}

}  // namespace

NetworkNode::NetworkNode() {
  Object::setType("NetworkNode");
  Object::setSolidness(SPECTRAL);
  registerInterest(NETWORK_EVENT);
}

int NetworkNode::eventHandler(const Event* p_e) {
  if (p_e->getType() != NETWORK_EVENT) return 0;
  const auto* p_network = dynamic_cast<const EventNetwork*>(p_e);
  if (p_network == nullptr) return 0;
  const NetworkEventLabel label = p_network->getLabel();
  if (label == NetworkEventLabel::ACCEPT) return handleAccept(p_network);
  if (label == NetworkEventLabel::CONNECT) return handleConnect(p_network);
  if (label == NetworkEventLabel::CLOSE) return handleClose(p_network);
  return label == NetworkEventLabel::DATA ? handleData(p_network) : 0;
}

int NetworkNode::sendMessage(MessageType /*msg_type*/, int sock) {
  return reach(sock);
}

int NetworkNode::sendMessage(MessageType msg_type, Object* p_obj, unsigned int attr, int sock) {
  if (p_obj == nullptr) return -1;
  const int result = reach(sock);
  if (result == 1 && msg_type == MessageType::SYNC_OBJECT) {
    std::stringstream nowhere;
    p_obj->serialize(&nowhere, attr);
  }
  return result;
}

int NetworkNode::sendMessage(MessageType msg_type, Object* p_obj, const std::string& attr, int sock) {
  if (p_obj == nullptr) return -1;
  const int result = reach(sock);
  if (result == 1 && msg_type == MessageType::SYNC_OBJECT) p_obj->serialize(attr);
  return result;
}

int NetworkNode::sendMessage(MessageType /*msg_type*/, EventKeyboardAction /*action*/, Keyboard::Key /*key*/,
                             int sock) {
  return reach(sock);
}

int NetworkNode::sendMessage(MessageType /*msg_type*/, EventMouseAction /*action*/, Mouse::Button /*button*/,
                             Vector /*mouse_position*/, int sock) {
  return reach(sock);
}

int NetworkNode::sendMessage(MessageType /*msg_type*/, int num_bytes, const void* bytes, int sock) {
  const int result = reach(sock);
  if (result == 1) NM.send(bytes, num_bytes, sock);
  return result;
}

}  // namespace df
