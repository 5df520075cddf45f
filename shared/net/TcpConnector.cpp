#include "TcpConnector.h"

#include <asio/connect.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <utility>
#include <vector>

#include "TcpChannel.h"

namespace naiad {
namespace {

using asio::ip::tcp;

std::string inWords(std::chrono::milliseconds time) {
  if (time.count() % 1000 == 0) return std::to_string(time.count() / 1000) + " s";
  return std::to_string(time.count()) + " ms";
}

}  // namespace

struct TcpConnector::Attempt : std::enable_shared_from_this<Attempt> {
  Attempt(asio::io_context& context, const TcpOptions& tcp_options)
      : resolver(context), socket(context), timer(context), options(tcp_options) {}

  void run(std::uint16_t port, std::chrono::milliseconds timeout);
  void onResolved(const std::error_code& error, const tcp::resolver::results_type& results);
  void onConnected(const std::error_code& error);
  void fail(const std::string& sentence);
  void stop();
  /// "127.0.0.1:9876", "[::1]:9876", as it was asked for.
  std::string target() const;

  tcp::resolver resolver;
  tcp::socket socket;
  asio::steady_timer timer;
  TcpOptions options;
  Done done;  // empty: this attempt is over
  std::string host;
  std::string service;
};

void TcpConnector::Attempt::run(std::uint16_t port, std::chrono::milliseconds timeout) {
  service = std::to_string(port);
  timer.expires_after(timeout);
  timer.async_wait([self = shared_from_this(), timeout](const std::error_code& error) {
    if (!error) self->fail("No answer from " + self->target() + " within " + inWords(timeout) + ".");
  });
  // No flag for "addresses configured": a machine that is off-line still has its loopback.
  resolver.async_resolve(
      host, service, tcp::resolver::numeric_service,
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
  std::vector<tcp::endpoint> here;
  for (const auto& result : results) {
    if (isLoopback(result.endpoint().address())) here.push_back(result.endpoint());
  }
  if (here.empty()) {
    const std::string address = results.begin()->endpoint().address().to_string();
    fail((address == host ? host : host + " (" + address + ")") +
         " is another machine: connections are not encrypted yet, so only loopback addresses are allowed.");
    return;
  }
  asio::async_connect(
      socket, here, [self = shared_from_this()](const std::error_code& connect_error, const tcp::endpoint&) {
        self->onConnected(connect_error);
      });
}

void TcpConnector::Attempt::onConnected(const std::error_code& error) {
  if (!done) return;
  std::error_code ignored;
  // A port that nobody listens on may be the very one the kernel picks for us; TCP then connects to itself.
  const bool myself = !error && socket.local_endpoint(ignored) == socket.remote_endpoint(ignored);
  if (myself || error == asio::error::connection_refused) {
    fail("Nothing listens on " + target() + " (connection refused).");
  } else if (error) {
    fail("Could not connect to " + target() + " (" + error.message() + ").");
  } else {
    const Done call = std::exchange(done, nullptr);
    timer.cancel();
    call(makeTcpChannel(std::move(socket), options), "");
  }
}

void TcpConnector::Attempt::fail(const std::string& sentence) {
  if (!done) return;
  const Done call = std::exchange(done, nullptr);
  stop();
  call(nullptr, sentence);
}

void TcpConnector::Attempt::stop() {
  done = nullptr;
  resolver.cancel();
  timer.cancel();
  std::error_code ignored;
  socket.close(ignored);
}

std::string TcpConnector::Attempt::target() const {
  return (host.find(':') != std::string::npos ? "[" + host + "]" : host) + ":" + service;
}

TcpConnector::TcpConnector(asio::io_context& context, TcpOptions options)
    : context_(context), options_(options) {}

TcpConnector::~TcpConnector() {
  cancel();
}

void TcpConnector::connect(const std::string& host, std::uint16_t port, std::chrono::milliseconds timeout,
                           Done done) {
  cancel();
  attempt_ = std::make_shared<Attempt>(context_, options_);
  attempt_->host = host;
  attempt_->done = std::move(done);
  attempt_->run(port, timeout);
}

void TcpConnector::cancel() {
  if (attempt_) attempt_->stop();
  attempt_.reset();
}

}  // namespace naiad
