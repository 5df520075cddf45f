// The handshake that opens a WebSocket, at a client's end (RFC 6455 4.1): what it asks for, and whether the
// answer grants that.
#pragma once

#include <string>
#include <string_view>

#include "shared/net/http/HttpExchange.h"
#include "shared/net/http/HttpHead.h"
#include "shared/net/http/WebSocketFraming.h"

namespace naiad {

class WebSocketUpgrade {
 public:
  /// Asks for this subprotocol, and no other. `key`: 16 bytes, new ones for each handshake.
  WebSocketUpgrade(std::string_view subprotocol, std::string_view key);

  /// Adds the fields of the handshake to a GET.
  void addTo(HttpRequest& request) const;
  /// Returns why the answer is a refusal or breaks the rules, in a few words; empty if the WebSocket is open.
  /// Nothing in it comes from the peer, except the number of the status.
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
