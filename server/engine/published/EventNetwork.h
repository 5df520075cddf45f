// The event of the published engine's sockets. The engine sends it only to games that are servers
// (NetworkManager.h), when players become connections or leave, and when the game closes a connection.
#pragma once

#include <string>

#include "Event.h"

namespace df {

inline const EventType NETWORK_EVENT("df-network");

enum class NetworkEventLabel {
  UNDEFINED = -1,
  ACCEPT,
  CONNECT,
  CLOSE,
  DATA,
};

/// Older names of the values of NetworkEventLabel.
namespace Network {
using Label = NetworkEventLabel;
inline constexpr NetworkEventLabel UNDEFINED_LABEL = NetworkEventLabel::UNDEFINED;
inline constexpr NetworkEventLabel ACCEPT = NetworkEventLabel::ACCEPT;
inline constexpr NetworkEventLabel CONNECT = NetworkEventLabel::CONNECT;
inline constexpr NetworkEventLabel CLOSE = NetworkEventLabel::CLOSE;
inline constexpr NetworkEventLabel DATA = NetworkEventLabel::DATA;
}  // namespace Network

class EventNetwork : public Event {
 public:
  explicit EventNetwork(NetworkEventLabel label) : Event(&NETWORK_EVENT), m_label(label) {}

  void setLabel(NetworkEventLabel new_label) { m_label = new_label; }
  NetworkEventLabel getLabel() const { return m_label; }
  void setSocket(int new_sock) { m_sock = new_sock; }
  int getSocket() const { return m_sock; }
  void setSocketIndex(int new_socket_index) { m_sock = new_socket_index; }
  int getSocketIndex() const { return m_sock; }
  void setBytes(int new_bytes) { m_bytes = new_bytes; }
  int getBytes() const { return m_bytes; }
  /// The message. Not owned.
  void setMessage(void* p_new_buff) { m_p_buff = p_new_buff; }
  void* getMessage() const { return m_p_buff; }

 private:
  NetworkEventLabel m_label;
  int m_sock = -1;
  int m_bytes = 0;
  void* m_p_buff = nullptr;
};

}  // namespace df
