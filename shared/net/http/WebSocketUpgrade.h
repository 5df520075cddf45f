// The client's part of a WebSocket handshake (RFC 6455 4.1): request fields, and the check of the answer.
#pragma once

#include <string>
#include <string_view>

#include "shared/net/http/HttpExchange.h"
#include "shared/net/http/HttpHead.h"
#include "shared/net/http/WebSocketFraming.h"

namespace naiad {

class WebSocketUpgrade {
 public:
  /// Requests this subprotocol, and no other. `key`: 16 bytes, new ones for each handshake.
  WebSocketUpgrade(std::string_view subprotocol, std::string_view key);

  /// Adds the fields of the handshake to a GET.
  void addTo(HttpRequest& request) const;
  /// Returns in a few words why the answer is a refusal or invalid; empty if the WebSocket is open. The text
  /// contains nothing from the peer except the status number.
  std::string problem(unsigned status, const HttpHead& answer) const;

 private:
  std::string m_subprotocol;
  std::string m_key;  // base64
};

/// Returns 16 unpredictable bytes for WebSocketUpgrade.
std::string randomWebSocketKey();
/// Returns an unpredictable mask for WebSocketFraming.
WebSocketFraming::Mask randomWebSocketMask();

}  // namespace naiad
