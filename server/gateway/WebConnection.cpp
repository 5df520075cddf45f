#include "server/gateway/WebConnection.h"

#include <array>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <utility>

#include "server/gateway/WebSocketRelay.h"

namespace naiad {
namespace {

namespace http = boost::beast::http;

constexpr std::uint32_t kMaxHead = 8 * 1024;  // bytes of a request's head
constexpr int kMaxRequests = 100;             // requests on one connection
/// Time for the browser to read a response: kResponseTimeout and 1 s per kResponseRate bytes.
constexpr std::chrono::seconds kResponseTimeout{30};
constexpr std::size_t kResponseRate = std::size_t{16} * 1024;
constexpr std::size_t kMaxQuoted = 100;  // maximum bytes of a header in the log

bool isHttpError(error_code error) {
  return error.category() == http::make_error_code(http::error::bad_method).category();
}

std::string headerText(const WebRequest& request, http::field name) {
  const auto value = request[name].substr(0, kMaxQuoted);
  return {value.data(), value.size()};
}

}  // namespace

WebConnection::WebConnection(GatewayState& gateway, SecureSocket socket, ProxiedPeer visitor)
    : GatewayConnection(gateway.sharedConnections()),
      m_gateway(gateway),
      m_socket(std::move(socket)),
      m_visitor(std::move(visitor)),
      m_buffer(kMaxHead + 1) {}

void WebConnection::start(PendingConnections::Slot slot) {
  m_slot = std::move(slot);
  setDeadline(m_gateway.settings.head_timeout);
  if (!m_gateway.tls) return readRequest();
  if (!m_socket.startTls(m_gateway.tls->get(), SecureSocket::Role::kServer)) return disconnect();
  m_socket.asyncHandshake([self = sharedFrom(this)](error_code error) {
    if (self->m_is_over) return;
    if (!error) return self->readRequest();
    ++self->m_gateway.counters.failed_handshakes;
    self->disconnect();
  });
}

void WebConnection::readRequest() {
  m_parser.emplace();
  m_parser->header_limit(kMaxHead);
  m_parser->body_limit(0);
  http::async_read_header(m_socket, m_buffer, *m_parser,
                          [self = sharedFrom(this)](error_code error, std::size_t) {
                            if (!self->m_is_over) self->onRequest(error);
                          });
}

void WebConnection::onRequest(error_code error) {
  if (error) return onBadRequest(error);
  ++m_gateway.counters.requests;
  if (!m_slot.setBusy()) {
    ++m_gateway.counters.no_slot;
    return disconnect();
  }
  if (!m_parser->is_done()) return refuse(400, "Request bodies are not allowed.\n");
  const WebRequest& request = m_parser->get();
  if (boost::beast::websocket::is_upgrade(request)) return onUpgrade();
  if (++m_requests == kMaxRequests) m_parser->get().keep_alive(false);
  send(m_gateway.responses.response(request));
}

void WebConnection::onBadRequest(error_code error) {
  const bool is_end = error == http::error::end_of_stream || error == http::error::partial_message;
  if (!isHttpError(error) || is_end) return disconnect();
  ++m_gateway.counters.bad_requests;
  if (!m_slot.setBusy()) return disconnect();
  if (error == http::error::header_limit || error == http::error::buffer_overflow)
    return refuse(431, "The request header is longer than 8 KiB.\n");
  if (error == http::error::body_limit) return refuse(413, "Request bodies are not allowed.\n");
  refuse(400, "This is not HTTP.\n");
}

void WebConnection::onUpgrade() {
  const WebRequest& request = m_parser->get();
  const auto* const refusal = m_gateway.responses.validateUpgrade(request);
  if (refusal) {
    ++m_gateway.counters.refused_upgrades;
    m_gateway.log.logRefusal(m_visitor.name,
                             "WebSocket from the page " + headerText(request, http::field::origin) +
                                 " to host " + headerText(request, http::field::host),
                             std::chrono::steady_clock::now());
    return refuse(refusal->status, refusal->message);
  }
  // A client must not send frames before the response to its upgrade.
  if (m_buffer.size() > 0) return refuse(400, "Data arrived before the WebSocket was open.\n");
  m_is_over = true;
  m_slot.setSilent();
  const auto stream = std::make_shared<WebSocketRelay>(m_gateway, std::move(m_socket), std::move(m_visitor),
                                                       std::move(m_slot));
  stream->accept(request);
}

void WebConnection::refuse(int status, std::string_view message) {
  send(m_gateway.responses.refusal(status, message));
}

void WebConnection::send(HttpResponse response) {
  m_response = std::move(response);
  if (m_response.is_refusal) ++m_gateway.counters.refused_requests;
  setDeadline(kResponseTimeout + std::chrono::seconds(m_response.body().size() / kResponseRate));
  const std::array<boost::asio::const_buffer, 2> buffers{
      boost::asio::buffer(m_response.head),
      boost::asio::buffer(m_response.body().data(), m_response.body().size())};
  boost::asio::async_write(m_socket, buffers, [self = sharedFrom(this)](error_code error, std::size_t) {
    if (!self->m_is_over) self->onSent(error);
  });
}

void WebConnection::onSent(error_code error) {
  if (error) return disconnect();
  if (m_response.keeps_connection) {
    m_slot.setSilent();
    setDeadline(m_gateway.settings.idle_timeout);
    return readRequest();
  }
  setDeadline(m_gateway.settings.close_timeout);
  m_socket.asyncDrain([self = sharedFrom(this)](error_code) { self->disconnect(); });
}

void WebConnection::onDeadline() {
  ++m_gateway.counters.timeouts;
  disconnect();
}

void WebConnection::disconnect() {
  m_is_over = true;
  clearDeadline();
  m_socket.close();
  m_slot = {};
}

}  // namespace naiad
