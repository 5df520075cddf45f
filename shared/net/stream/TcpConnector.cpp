#include "shared/net/stream/TcpConnector.h"

#include <sys/un.h>

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/post.hpp>
#include <asio/write.hpp>
#include <utility>
#include <vector>

#include "shared/net/stream/PatientTimer.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/net/stream/TlsHandshake.h"
#include "shared/net/stream/VisitorHeader.h"

namespace naiad {
namespace {

using asio::ip::tcp;

std::string inWords(std::chrono::milliseconds time) {
  if (time.count() % 1000 == 0) return std::to_string(time.count() / 1000) + " s";
  return std::to_string(time.count()) + " ms";
}

}  // namespace

struct TcpConnector::Attempt : std::enable_shared_from_this<Attempt> {
  Attempt(TcpConnector& owner, std::string target_host, Done callback)
      : connector(owner),
        resolver(owner.context_),
        socket(owner.context_),
        door(owner.context_),
        timer(owner.context_),
        share(owner.context_),
        done(std::move(callback)),
        host(std::move(target_host)) {}

  void resolve(std::uint16_t to_port, std::chrono::milliseconds timeout);
  void limit(std::chrono::milliseconds timeout);
  void onResolved(const std::error_code& error, const tcp::resolver::results_type& results);
  void take(const std::vector<tcp::endpoint>& addresses);
  void tryNext();
  void onConnected(const std::error_code& error);
  void enter(const std::string& path, const tcp::endpoint& visitor);
  void onEntered(const std::error_code& error, const std::string& path, const tcp::endpoint& visitor);
  void shakeHands(ByteStream::Socket connected);
  void onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream, const std::string& problem);
  void giveOut(std::unique_ptr<ReliableChannel> channel, std::optional<PeerFacts> facts);
  void fail(const std::string& sentence);
  void hangUp();
  void stop();
  /// "127.0.0.1:9876", "[::1]:9876", as it was asked for.
  std::string target() const;

  TcpConnector& connector;  // there while `done` is
  tcp::resolver resolver;
  tcp::socket socket;
  asio::local::stream_protocol::socket door;  // in place of `socket`: TcpConnector::connectFor()
  PatientTimer timer;
  PatientTimer share;  // of the address that is being tried
  std::shared_ptr<TlsHandshake> handshake;
  Done done;  // empty: this attempt is over
  std::string host;
  std::uint16_t port = 0;
  std::chrono::milliseconds total{};
  std::vector<tcp::endpoint> endpoints;
  std::size_t turn = 0;  // endpoints[turn - 1] is being tried
  std::string last_problem;
};

void TcpConnector::Attempt::limit(std::chrono::milliseconds timeout) {
  total = timeout;
  timer.start(timeout, [self = shared_from_this()] {
    self->fail("No answer from " + self->target() + " within " + inWords(self->total) + ".");
  });
}

void TcpConnector::Attempt::resolve(std::uint16_t to_port, std::chrono::milliseconds timeout) {
  port = to_port;
  limit(timeout);
  // No flag for "addresses configured": a machine that is off-line still has its loopback.
  resolver.async_resolve(
      host, std::to_string(port), tcp::resolver::numeric_service,
      [self = shared_from_this()](const std::error_code& error, const tcp::resolver::results_type& results) {
        self->onResolved(error, results);
      });
}

void TcpConnector::Attempt::onResolved(const std::error_code& error,
                                       const tcp::resolver::results_type& results) {
  if (!done) return;
  if (error || results.empty()) {
    fail("The host name \"" + host + "\" could not be found (" + error.message() + ").");
    return;
  }
  std::vector<tcp::endpoint> found;
  for (const auto& result : results) found.push_back(result.endpoint());
  take(found);
}

void TcpConnector::Attempt::take(const std::vector<tcp::endpoint>& addresses) {
  const auto& is_allowed = connector.is_allowed_;
  bool is_restricted = false;
  for (const tcp::endpoint& endpoint : addresses) {
    if (is_allowed && !is_allowed(endpoint.address())) {
      is_restricted = true;
    } else if (connector.tls_ || isLoopback(endpoint.address())) {
      endpoints.push_back(endpoint);
    }
  }
  if (endpoints.empty() && is_restricted)
    return fail(target() + " is nearer to you than the server that sent you there: that is not followed.");
  if (endpoints.empty()) {
    const std::string address = addresses.empty() ? "no address" : addresses.front().address().to_string();
    fail((address == host ? host : host + " (" + address + ")") +
         " is another machine: without encryption only loopback addresses are allowed.");
    return;
  }
  tryNext();
}

/// A small "happy eyeballs" (RFC 8305 without the races): a silent address costs its share of the time, no
/// more.
void TcpConnector::Attempt::tryNext() {
  hangUp();
  if (turn == endpoints.size()) return fail(last_problem);
  const std::size_t mine = ++turn;
  if (mine < endpoints.size()) {  // the last one has all the time that is left
    share.start(total / static_cast<int>(endpoints.size()), [self = shared_from_this(), mine] {
      if (self->done && self->turn == mine) self->tryNext();
    });
  }
  socket.async_connect(endpoints[mine - 1], [self = shared_from_this(), mine](const std::error_code& error) {
    if (self->done && self->turn == mine) self->onConnected(error);
  });
}

void TcpConnector::Attempt::onConnected(const std::error_code& error) {
  std::error_code ignored;
  // A port without a listener may be the very one the kernel picks for us; TCP then connects to itself.
  const bool myself = !error && socket.local_endpoint(ignored) == socket.remote_endpoint(ignored);
  if (myself || error == asio::error::connection_refused) {
    last_problem = "Nothing listens on " + target() + " (connection refused).";
    tryNext();
  } else if (error) {
    last_problem = "Could not connect to " + target() + " (" + error.message() + ").";
    tryNext();
  } else if (connector.tls_) {
    shakeHands(std::move(socket));
  } else {
    giveOut(makeTcpChannel(std::move(socket), connector.options_), std::nullopt);
  }
}

void TcpConnector::Attempt::enter(const std::string& path, const tcp::endpoint& visitor) {
  if (path.size() >= sizeof(sockaddr_un::sun_path))
    return fail(path + " is too long for the path of a socket.");
  door.async_connect(asio::local::stream_protocol::endpoint(path),
                     [self = shared_from_this(), path, visitor](const std::error_code& error) {
                       if (self->done) self->onEntered(error, path, visitor);
                     });
}

void TcpConnector::Attempt::onEntered(const std::error_code& error, const std::string& path,
                                      const tcp::endpoint& visitor) {
  std::error_code failed = error;
  const std::string header = visitorHeader(visitor);
  // It fits into the socket's empty buffer as a whole.
  if (!failed) asio::write(door, asio::buffer(header), failed);
  if (!failed) return shakeHands(std::move(door));
  connector.was_hung_up_on_ = failed == asio::error::try_again || failed == asio::error::broken_pipe;
  fail("Could not connect through " + path + " (" + failed.message() + ").");
}

void TcpConnector::Attempt::shakeHands(ByteStream::Socket connected) {
  try {
    handshake = std::make_shared<TlsHandshake>(
        std::make_unique<TlsStream>(std::move(connected), connector.tls_, host));
  } catch (const TlsError& error) {
    fail(error.what());
    return;
  }
  handshake->run(total, [self = shared_from_this()](TlsHandshake::End end, std::unique_ptr<TlsStream> stream,
                                                    const std::string& problem) {
    self->onHandshake(end, std::move(stream), problem);
  });
}

void TcpConnector::Attempt::onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream,
                                        const std::string& problem) {
  if (!done || end == TlsHandshake::End::kTimedOut) return;  // the attempt's own timer speaks
  const auto facts = stream ? stream->peerFacts() : std::nullopt;
  if (facts) {
    giveOut(makeTcpChannel(std::move(stream), connector.options_), facts);
  } else {
    connector.was_hung_up_on_ = end == TlsHandshake::End::kHungUp;
    fail(target() + " does not answer as a Naiad server (" + problem + ").");
  }
}

void TcpConnector::Attempt::giveOut(std::unique_ptr<ReliableChannel> channel,
                                    std::optional<PeerFacts> facts) {
  connector.peer_facts_ = std::move(facts);
  const Done call = std::exchange(done, nullptr);
  stop();
  call(std::move(channel), "");
}

void TcpConnector::Attempt::fail(const std::string& sentence) {
  if (!done) return;
  const Done call = std::exchange(done, nullptr);
  stop();
  call(nullptr, sentence);
}

void TcpConnector::Attempt::hangUp() {
  share.cancel();
  if (const auto old = std::exchange(handshake, nullptr)) old->cancel();
  std::error_code ignored;
  socket.close(ignored);
  door.close(ignored);
}

void TcpConnector::Attempt::stop() {
  done = nullptr;
  resolver.cancel();
  timer.cancel();
  hangUp();
}

std::string TcpConnector::Attempt::target() const {
  return (host.find(':') != std::string::npos ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

TcpConnector::TcpConnector(asio::io_context& context, TcpOptions options,
                           std::shared_ptr<const TlsContext> tls)
    : context_(context), options_(options), tls_(std::move(tls)) {}

TcpConnector::~TcpConnector() {
  cancel();
}

void TcpConnector::connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                           Done done) {
  begin(host, std::move(done))->resolve(port, timeout);
}

void TcpConnector::connect(const std::string& host, const std::vector<tcp::endpoint>& endpoints,
                           std::chrono::milliseconds timeout, Done done) {
  const auto attempt = begin(host, std::move(done));
  attempt->port = endpoints.empty() ? 0 : endpoints.front().port();
  attempt->limit(timeout);
  asio::post(context_, [attempt, endpoints] {
    if (attempt->done) attempt->take(endpoints);
  });
}

void TcpConnector::connectFor(const tcp::endpoint& visitor, const std::string& socket,
                              const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                              Done done) {
  const auto attempt = begin(host, std::move(done));
  attempt->port = port;
  attempt->limit(timeout);
  asio::post(context_, [attempt, socket, visitor] {
    if (attempt->done) attempt->enter(socket, visitor);
  });
}

std::shared_ptr<TcpConnector::Attempt> TcpConnector::begin(const std::string& host, Done done) {
  cancel();
  attempt_ = std::make_shared<Attempt>(*this, host, std::move(done));
  return attempt_;
}

void TcpConnector::cancel() {
  if (attempt_) attempt_->stop();
  attempt_.reset();
  peer_facts_.reset();
  was_hung_up_on_ = false;
}

}  // namespace naiad
