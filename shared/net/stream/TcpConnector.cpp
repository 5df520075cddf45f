#include "shared/net/stream/TcpConnector.h"

#include "shared/net/stream/StreamAttempt.h"

namespace naiad {
namespace {

using asio::ip::tcp;
using End = StreamResult::End;

std::string inWords(std::chrono::milliseconds time) {
  if (time.count() % 1000 == 0) return std::to_string(time.count() / 1000) + " s";
  return std::to_string(time.count()) + " ms";
}

/// Returns the reason, for people, why there is no channel to `target`.
std::string errorText(const StreamResult& result, const StreamTarget& target,
                      std::chrono::milliseconds timeout) {
  const std::string where = target.text();
  const std::string& host = target.host;
  const std::string& detail = result.detail;
  switch (result.end) {
    case End::kOpen:
      return {};
    case End::kNotFound:
      return "The host name \"" + host + "\" could not be found (" + detail + ").";
    case End::kNotAllowed:
      return where + " is in a more private network than the redirecting server: redirect refused.";
    case End::kOtherMachine:
      return (detail == host ? host : host + " (" + detail + ")") +
             " is another machine: without encryption only loopback addresses are allowed.";
    case End::kRefused:
      return "Nothing listens on " + where + " (" + detail + ").";
    case End::kUnreachable:
      return "Could not connect to " + where + " (" + detail + ").";
    case End::kHandshake:
      if (result.closed_in_handshake)
        return where +
               " closed the connection: your address may be banned there, or no Naiad server runs there.";
      return where + " does not answer as a Naiad server (" + detail + ").";
    case End::kTimedOut:
      return "No answer from " + where + " within " + inWords(timeout) + ".";
    case End::kUnusable:
      return detail;
  }
  return detail;
}

}  // namespace

TcpConnector::TcpConnector(asio::io_context& context, TcpOptions options,
                           std::shared_ptr<const TlsContext> tls)
    : context_(context), options_(options), tls_(std::move(tls)) {}

TcpConnector::~TcpConnector() {
  cancel();
}

void TcpConnector::connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                           Done done) {
  begin(host, port, timeout, std::move(done)).resolve();
}

void TcpConnector::connect(const std::string& host, const std::vector<tcp::endpoint>& endpoints,
                           std::chrono::milliseconds timeout, Done done) {
  const std::uint16_t port = endpoints.empty() ? std::uint16_t{0} : endpoints.front().port();
  begin(host, port, timeout, std::move(done)).connect(endpoints);
}

void TcpConnector::connectFor(const tcp::endpoint& visitor, const std::string& socket,
                              const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                              Done done) {
  begin(host, port, timeout, std::move(done)).connectThroughProxy(socket, visitor);
}

StreamAttempt& TcpConnector::begin(const std::string& host, std::uint16_t port,
                                   std::chrono::milliseconds timeout, Done done) {
  cancel();
  const StreamTarget target{host, port, tls_, is_allowed_};
  attempt_ = std::make_shared<StreamAttempt>(
      context_, target, timeout, [this, target, timeout, done = std::move(done)](StreamResult result) {
        peer_identity_ = std::move(result.peer_identity);
        closed_during_handshake_ = result.closed_in_handshake;
        auto channel = result.stream ? makeTcpChannel(std::move(result.stream), options_) : nullptr;
        done(std::move(channel), errorText(result, target, timeout));
      });
  return *attempt_;
}

void TcpConnector::cancel() {
  if (attempt_) attempt_->cancel();
  attempt_.reset();
  peer_identity_.reset();
  closed_during_handshake_ = false;
}

}  // namespace naiad
