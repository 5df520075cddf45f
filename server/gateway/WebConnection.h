// A browser's connection until it ends or becomes a WebSocket: TLS (if configured), requests and answers.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <memory>
#include <optional>

#include "server/gateway/GatewayState.h"
#include "server/gateway/SecureSocket.h"

namespace naiad {

/// Memory: at most 8 KiB for a request's head, and OpenSSL's for one connection.
/// Thread: the gateway's.
class WebConnection : public Guest {
 public:
  WebConnection(GatewayState& gateway, SecureSocket socket, VisitorFacts visitor);

  /// Begins to serve. `place`: the connection's place among the newcomers.
  void start(Newcomers::Place place);

  void onDeadline() override;
  void endService() override { hangUp(); }
  void hangUp() override;

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::empty_body>;

  void readRequest();
  void onRequest(error_code error);
  void onBadRequest(error_code error);
  void onUpgrade();
  void refuse(int status, std::string_view sentence);
  void send(HttpAnswer answer);
  void onSent(error_code error);

  GatewayState& m_gateway;
  SecureSocket m_socket;
  VisitorFacts m_visitor;
  Newcomers::Place m_place;
  boost::beast::flat_buffer m_buffer;
  std::optional<Parser> m_parser;
  HttpAnswer m_answer;
  int m_requests = 0;
  bool m_is_over = false;
};

}  // namespace naiad
