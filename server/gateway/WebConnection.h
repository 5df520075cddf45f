// A browser's connection until it ends or becomes a WebSocket: TLS (if configured), requests and responses.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <memory>
#include <optional>

#include "server/gateway/GatewayState.h"
#include "server/gateway/SecureSocket.h"

namespace naiad {

/// Uses at most 8 KiB for a request's head, in addition to OpenSSL's memory for one connection.
/// Use on the gateway's thread.
class WebConnection : public GatewayConnection {
 public:
  WebConnection(GatewayState& gateway, SecureSocket socket, ProxiedPeer visitor);

  /// Begins to serve. `slot`: the connection's slot among the PendingConnections.
  void start(PendingConnections::Slot slot);

  void onDeadline() override;
  void shutDown() override { disconnect(); }
  void disconnect() override;

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  void readRequest();
  void onRequest(error_code error);
  void onBadRequest(error_code error);
  void onUpgrade();
  void refuse(int status, std::string_view message);
  void send(HttpResponse response);
  void onSent(error_code error);

  GatewayState& m_gateway;
  SecureSocket m_socket;
  ProxiedPeer m_visitor;
  PendingConnections::Slot m_slot;
  boost::beast::flat_buffer m_buffer;
  std::optional<Parser> m_parser;
  HttpResponse m_response;
  int m_requests = 0;
  bool m_is_over = false;
};

}  // namespace naiad
