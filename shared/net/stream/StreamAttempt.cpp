#include "shared/net/stream/StreamAttempt.h"

#include <sys/un.h>

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/write.hpp>
#include <utility>

#include "shared/net/stream/ProxyHeader.h"
#include "shared/net/stream/TcpChannel.h"

namespace naiad {

using asio::ip::tcp;

std::string StreamTarget::text() const {
  return (host.find(':') != std::string::npos ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

StreamAttempt::StreamAttempt(asio::io_context& context, StreamTarget target,
                             std::chrono::milliseconds timeout, Done done)
    : context_(context),
      target_(std::move(target)),
      timeout_(timeout),
      done_(std::move(done)),
      resolver_(context),
      socket_(context),
      proxy_socket_(context),
      timer_(context),
      share_(context) {}

void StreamAttempt::limit() {
  timer_.start(timeout_, [self = shared_from_this()] { self->fail(End::kTimedOut, "timed out"); });
}

void StreamAttempt::resolve() {
  limit();
  // No "addresses configured" flag: an off-line machine still has its loopback.
  resolver_.async_resolve(
      target_.host, std::to_string(target_.port), tcp::resolver::numeric_service,
      [self = shared_from_this()](const std::error_code& error, const tcp::resolver::results_type& results) {
        self->onResolved(error, results);
      });
}

void StreamAttempt::connect(const std::vector<tcp::endpoint>& endpoints) {
  limit();
  asio::post(context_, [self = shared_from_this(), endpoints] {
    if (self->done_) self->choose(endpoints);
  });
}

void StreamAttempt::connectThroughProxy(const std::string& path, const tcp::endpoint& visitor) {
  limit();
  asio::post(context_, [self = shared_from_this(), path, visitor] {
    if (!self->done_) return;
    if (path.size() >= sizeof(sockaddr_un::sun_path))
      return self->fail(End::kUnusable, path + " is too long for the path of a socket.");
    self->proxy_socket_.async_connect(asio::local::stream_protocol::endpoint(path),
                                      [self, path, visitor](const std::error_code& error) {
                                        if (self->done_) self->onProxyConnected(error, path, visitor);
                                      });
  });
}

void StreamAttempt::onResolved(const std::error_code& error, const tcp::resolver::results_type& results) {
  if (!done_) return;
  if (error || results.empty()) return fail(End::kNotFound, error.message());
  std::vector<tcp::endpoint> found;
  for (const auto& result : results) found.push_back(result.endpoint());
  choose(found);
}

void StreamAttempt::choose(const std::vector<tcp::endpoint>& addresses) {
  bool is_restricted = false;
  for (const tcp::endpoint& endpoint : addresses) {
    if (target_.is_allowed && !target_.is_allowed(endpoint.address())) {
      is_restricted = true;
    } else if (target_.tls || isLoopback(endpoint.address())) {
      endpoints_.push_back(endpoint);
    }
  }
  if (!endpoints_.empty()) return tryNext();
  if (is_restricted) return fail(End::kNotAllowed, "this address is not allowed");
  fail(End::kOtherMachine, addresses.empty() ? "no address" : addresses.front().address().to_string());
}

/// Tries the next address, like "happy eyeballs" (RFC 8305) but one at a time: a silent one costs its share
/// of the timeout.
void StreamAttempt::tryNext() {
  disconnect();
  if (turn_ == endpoints_.size()) return fail(last_end_, last_detail_);
  const std::size_t mine = ++turn_;
  if (mine < endpoints_.size()) {  // the last address has all remaining time
    share_.start(timeout_ / static_cast<int>(endpoints_.size()), [self = shared_from_this(), mine] {
      if (self->done_ && self->turn_ == mine) self->tryNext();
    });
  }
  socket_.async_connect(endpoints_[mine - 1],
                        [self = shared_from_this(), mine](const std::error_code& error) {
                          if (self->done_ && self->turn_ == mine) self->onConnected(error);
                        });
}

void StreamAttempt::onConnected(const std::error_code& error) {
  std::error_code ignored;
  // If nothing listens, the kernel may choose this port for the client's end; TCP then connects to itself.
  const bool myself = !error && socket_.local_endpoint(ignored) == socket_.remote_endpoint(ignored);
  if (myself || error) {
    const bool refused = myself || error == asio::error::connection_refused;
    last_end_ = refused ? End::kRefused : End::kUnreachable;
    last_detail_ = refused ? "connection refused" : error.message();
    tryNext();
  } else if (target_.tls) {
    startHandshake(std::move(socket_));
  } else {
    finish({.stream = std::make_unique<PlainStream>(std::move(socket_))});
  }
}

void StreamAttempt::onProxyConnected(const std::error_code& error, const std::string& path,
                                     const tcp::endpoint& visitor) {
  std::error_code failed = error;
  const std::string header = proxyHeader(visitor);
  // Does not block, because the header fits into the socket's empty buffer.
  if (!failed) asio::write(proxy_socket_, asio::buffer(header), failed);
  if (!failed) return startHandshake(std::move(proxy_socket_));
  fail(End::kUnusable, "Could not connect through " + path + " (" + failed.message() + ").",
       failed == asio::error::try_again || failed == asio::error::broken_pipe);
}

void StreamAttempt::startHandshake(ByteStream::Socket connected) {
  try {
    handshake_ = std::make_shared<TlsHandshake>(
        std::make_unique<TlsStream>(std::move(connected), target_.tls, target_.host));
  } catch (const TlsError& error) {
    return fail(End::kUnusable, error.what());
  }
  handshake_->run(timeout_,
                  [self = shared_from_this()](TlsHandshake::End end, std::unique_ptr<TlsStream> stream,
                                              const std::string& problem) {
                    self->onHandshake(end, std::move(stream), problem);
                  });
}

void StreamAttempt::onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream,
                                const std::string& problem) {
  if (!done_ || end == TlsHandshake::End::kTimedOut) return;  // the attempt's timer reports timeouts
  auto facts = stream ? stream->peerIdentity() : std::nullopt;
  if (!facts) return fail(End::kHandshake, problem, end == TlsHandshake::End::kDisconnected);
  finish({.stream = std::move(stream), .peer_identity = std::move(facts)});
}

void StreamAttempt::finish(StreamResult result) {
  const Done call = std::exchange(done_, nullptr);
  if (!call) return;
  cancel();
  call(std::move(result));
}

void StreamAttempt::fail(End end, const std::string& detail, bool closed_in_handshake) {
  finish({.end = end, .detail = detail, .closed_in_handshake = closed_in_handshake});
}

void StreamAttempt::disconnect() {
  share_.cancel();
  if (const auto old = std::exchange(handshake_, nullptr)) old->cancel();
  std::error_code ignored;
  socket_.close(ignored);
  proxy_socket_.close(ignored);
}

void StreamAttempt::cancel() {
  done_ = nullptr;
  resolver_.cancel();
  timer_.cancel();
  disconnect();
}

}  // namespace naiad
