#include "client/session/GatewayStreamOpener.h"

#include <asio/io_context.hpp>
#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/net/base/WebSocketProtocol.h"
#include "shared/net/http/HttpExchange.h"
#include "shared/net/http/WebSocketFraming.h"
#include "shared/net/http/WebSocketUpgrade.h"
#include "shared/net/stream/TcpChannel.h"

namespace naiad {
namespace {

using End = HttpExchange::End;

/// Returns the TLS context that a thread's connections share: making one reads the system's trust store.
const std::shared_ptr<const TlsContext>& webContext() {
  thread_local const std::shared_ptr<const TlsContext> made = TlsContext::forWebClient();
  return made;
}

/// Returns why no WebSocket was opened, for people.
std::string errorText(const HttpExchange::Result& result) {
  const std::string reason = result.detail.empty() ? "." : " (" + result.detail + ").";
  switch (result.end) {
    case End::kNotFound:
      return "The host of the gateway was not found" + reason;
    case End::kOtherMachine:
      return "Without encryption (https) only gateways on this machine are allowed.";
    case End::kUnreachable:
      return "The gateway cannot be reached" + reason;
    case End::kUntrusted:
      return "No secure connection to the gateway" + reason;
    case End::kTimedOut:
      return "The gateway does not answer.";
    default:
      return "Cannot join through the gateway" + reason;
  }
}

}  // namespace

GatewayStreamOpener::GatewayStreamOpener(asio::io_context& context, GatewayAddress address)
    : m_context(context), m_address(std::move(address)) {}

GatewayStreamOpener::~GatewayStreamOpener() {
  cancel();
}

void GatewayStreamOpener::begin(std::shared_ptr<HttpExchange>& attempt, Done done) {
  if (attempt) attempt->cancel();
  const WebSocketUpgrade upgrade(kSubprotocol, randomWebSocketKey());
  HttpRequest request{.target = std::string(kPlayPath), .host = m_address.hostText()};
  request.fields = {{"Origin", m_address.origin()}};
  upgrade.addTo(request);
  attempt = std::make_shared<HttpExchange>(m_context);
  attempt->run({m_address.host, m_address.port, m_address.encrypted ? webContext() : nullptr}, request,
               kOpenTimeout, [&attempt, upgrade, done = std::move(done)](HttpExchange::Result result) {
                 const auto exchange = std::exchange(attempt, nullptr);
                 const HttpResponseReader& answer = exchange->answer();
                 if (result.end == End::kAnswered)
                   result.detail = upgrade.problem(answer.status(), answer.head());
                 if (result.end != End::kAnswered || !result.detail.empty())
                   return done(nullptr, errorText(result));
                 auto framing = std::make_unique<WebSocketFraming>(kMaxServerFrame, randomWebSocketMask);
                 framing->feed(exchange->bytesBehind());
                 done(makeFramedChannel(exchange->releaseStream(), std::move(framing)), "");
               });
}

void GatewayStreamOpener::cancel() {
  for (std::shared_ptr<HttpExchange>* attempt : {&m_first, &m_second}) {
    if (*attempt) std::exchange(*attempt, nullptr)->cancel();
  }
}

}  // namespace naiad
