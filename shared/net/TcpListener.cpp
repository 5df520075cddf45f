#include "TcpListener.h"

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/ip/v6_only.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <sstream>
#include <utility>

#include "TcpChannel.h"

namespace naiad {
namespace {

using asio::ip::tcp;

/// How long to wait for descriptors or memory to come free.
constexpr std::chrono::milliseconds kRetryDelay{100};

}  // namespace

struct TcpListener::State : std::enable_shared_from_this<State> {
  State(asio::io_context& context, OnChannel callback, const TcpOptions& tcp_options)
      : acceptor(context), retry(context), on_channel(std::move(callback)), options(tcp_options) {}

  void listen(const std::string& numeric_address, std::uint16_t port);
  void accept();
  void onAccepted(const std::error_code& error, tcp::socket socket);

  tcp::acceptor acceptor;
  asio::steady_timer retry;
  tcp::endpoint endpoint;
  OnChannel on_channel;  // as long-lived as this, for a callback may destroy the listener
  TcpOptions options;
  std::uint64_t failed = 0;
};

void TcpListener::State::listen(const std::string& numeric_address, std::uint16_t port) {
  std::error_code error;
  const auto address = asio::ip::make_address(numeric_address, error);
  const auto refused = std::make_error_code(std::errc::invalid_argument);
  if (error) throw ListenError("\"" + numeric_address + "\" is not a numeric IPv4 or IPv6 address.", refused);
  if (!isLoopback(address)) {
    throw ListenError("Cannot listen on " + numeric_address +
                          ": connections are not encrypted yet, so only loopback addresses are allowed.",
                      refused);
  }
  endpoint = tcp::endpoint(address, port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && address.is_v6()) acceptor.set_option(asio::ip::v6_only(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (!error) endpoint = acceptor.local_endpoint(error);
  if (!error) return;
  error.assign(error.value(), std::generic_category());  // Asio's category does not compare with std::errc
  const std::string where = "port " + std::to_string(port) + " on " + numeric_address;
  if (error == std::errc::address_in_use) {
    throw ListenError("Cannot listen: " + where + " is in use by another program.", error);
  }
  throw ListenError("Cannot listen on " + where + " (" + error.message() + ").", error);
}

void TcpListener::State::accept() {
  acceptor.async_accept([self = shared_from_this()](const std::error_code& error, tcp::socket socket) {
    self->onAccepted(error, std::move(socket));
  });
}

void TcpListener::State::onAccepted(const std::error_code& error, tcp::socket socket) {
  if (!acceptor.is_open()) return;
  if (!error) {
    on_channel(makeTcpChannel(std::move(socket), options));
    if (acceptor.is_open()) accept();
    return;
  }
  ++failed;
  retry.expires_after(kRetryDelay);
  retry.async_wait([self = shared_from_this()](const std::error_code&) {
    if (self->acceptor.is_open()) self->accept();
  });
}

TcpListener::TcpListener(asio::io_context& context, const std::string& address, std::uint16_t port,
                         OnChannel on_channel, TcpOptions options)
    : state_(std::make_shared<State>(context, std::move(on_channel), options)) {
  state_->listen(address, port);
  state_->accept();
}

TcpListener::~TcpListener() {
  close();
}

std::uint16_t TcpListener::port() const {
  return state_->endpoint.port();
}

std::string TcpListener::address() const {
  std::ostringstream text;
  text << state_->endpoint;
  return text.str();
}

std::uint64_t TcpListener::failedAccepts() const {
  return state_->failed;
}

void TcpListener::close() {
  std::error_code ignored;
  state_->acceptor.close(ignored);
  state_->retry.cancel();
}

}  // namespace naiad
