#include "shared/net/stream/TcpListener.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <asio/io_context.hpp>
#include <asio/ip/v6_only.hpp>
#include <cerrno>
#include <map>
#include <sstream>
#include <utility>

#include "shared/net/stream/AcceptLoop.h"
#include "shared/net/stream/HalfOpenLimit.h"
#include "shared/net/stream/TlsStream.h"

namespace naiad {

using asio::ip::tcp;

struct TcpListener::State : AcceptLoop<State, tcp> {
  State(asio::io_context& context, OnChannel callback, const TcpOptions& tcp_options,
        TlsListenerOptions tls_listening)
      : AcceptLoop(context),
        on_channel(std::move(callback)),
        options(tcp_options),
        tls(std::move(tls_listening)),
        strangers({tls.max_half_open, tls.max_half_open_per_prefix}),
        known({tls.max_half_open_known, tls.max_half_open_per_prefix}) {}

  void listen(const std::string& numeric_address, std::uint16_t port);
  void adoptListening(int socket);
  void requireEncryption(const asio::ip::address& address) const;
  void deferAccepts();
  void onConnection(tcp::socket socket);
  void startHandshake(ByteStream::Socket socket, const tcp::endpoint& peer);
  void refuse(const tcp::endpoint& peer, StreamRefusal why);
  bool makeRoom(HalfOpenLimit& places, const tcp::endpoint& peer);
  bool judgeHello(HalfOpenLimit& places, HalfOpenLimit::Id id, const tcp::endpoint& peer);
  void hangUp(HalfOpenLimit& places, HalfOpenLimit::Id id);
  void onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream);
  void close();

  tcp::endpoint endpoint;
  OnChannel on_channel;  // stored here because a callback may destroy the listener
  TcpOptions options;
  TlsListenerOptions tls;
  HalfOpenLimit strangers;
  HalfOpenLimit known;  // connections for which TlsListenerOptions::is_known is true
  std::map<HalfOpenLimit::Id, std::shared_ptr<TlsHandshake>> handshakes;
  HalfOpenLimit::Id newest = 0;
  Counters counters;
};

void TcpListener::State::requireEncryption(const asio::ip::address& address) const {
  if (tls.context || isLoopback(address)) return;
  throw ListenError("Cannot listen on " + address.to_string() +
                        ": connections are not encrypted, so only loopback addresses are allowed.",
                    std::make_error_code(std::errc::invalid_argument));
}

void TcpListener::State::deferAccepts() {
  if (!tls.context || tls.defer_accept.count() <= 0) return;
  const int seconds = static_cast<int>(tls.defer_accept.count());  // on failure, silent peers are accepted
  setsockopt(acceptor.native_handle(), IPPROTO_TCP, TCP_DEFER_ACCEPT, &seconds, sizeof seconds);
}

void TcpListener::State::adoptListening(int socket) {
  sockaddr_storage name{};
  socklen_t size = sizeof name;
  std::error_code error;
  if (getsockname(socket, reinterpret_cast<sockaddr*>(&name), &size) != 0)
    throw ListenError("Cannot listen with a socket from the service manager.",
                      {errno, std::generic_category()});
  acceptor.assign(name.ss_family == AF_INET6 ? tcp::v6() : tcp::v4(), socket, error);
  if (!error) endpoint = acceptor.local_endpoint(error);
  if (error)
    throw ListenError("Cannot listen with a socket from the service manager (" + error.message() + ").",
                      error);
  requireEncryption(endpoint.address());
  deferAccepts();
}

void TcpListener::State::listen(const std::string& numeric_address, std::uint16_t port) {
  std::error_code error;
  const auto address = asio::ip::make_address(numeric_address, error);
  if (error) {
    throw ListenError("\"" + numeric_address + "\" is not a numeric IPv4 or IPv6 address.",
                      std::make_error_code(std::errc::invalid_argument));
  }
  requireEncryption(address);
  endpoint = tcp::endpoint(address, port);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
  if (!error && address.is_v6()) {
    acceptor.set_option(asio::ip::v6_only(!address.is_unspecified()), error);
  }
  if (!error) acceptor.bind(endpoint, error);
  if (!error) deferAccepts();
  if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
  if (!error) endpoint = acceptor.local_endpoint(error);
  if (!error) return;
  error.assign(error.value(), std::generic_category());  // Asio's codes never equal std::errc
  const std::string where = "port " + std::to_string(port) + " on " + numeric_address;
  if (error == std::errc::address_in_use) {
    throw ListenError("Cannot listen: " + where + " is in use by another program.", error);
  }
  throw ListenError("Cannot listen on " + where + " (" + error.message() + ").", error);
}

void TcpListener::State::onConnection(tcp::socket socket) {
  if (!tls.context) return on_channel(makeTcpChannel(std::move(socket), options));
  std::error_code gone;
  const tcp::endpoint peer = socket.remote_endpoint(gone);
  if (!gone) return startHandshake(std::move(socket), peer);
  ++counters.handshakes_failed;
}

void TcpListener::State::startHandshake(ByteStream::Socket socket, const tcp::endpoint& peer) {
  if (tls.is_banned && tls.is_banned(peer.address())) return refuse(peer, StreamRefusal::kBanned);
  const AddressPrefix prefix = AddressPrefix::of(peer.address());
  if (tls.can_handshake && !tls.can_handshake(prefix))  // refused early to save OpenSSL's memory
    return refuse(peer, StreamRefusal::kTooOften);
  HalfOpenLimit& places = tls.is_known && tls.is_known(prefix) ? known : strangers;
  if (!makeRoom(places, peer)) return;
  std::shared_ptr<TlsHandshake> handshake;
  try {
    handshake = std::make_shared<TlsHandshake>(
        std::make_unique<TlsStream>(std::move(socket), tls.context, "", peerName(peer)));
  } catch (const TlsError&) {  // out of memory
    ++counters.handshakes_failed;
    return;
  }
  const HalfOpenLimit::Id id = ++newest;
  places.admit(id, prefix);
  handshakes[id] = handshake;
  const bool hasty = places.isCrowded();
  handshake->run(
      hasty ? tls.handshake_timeout / 4 : tls.handshake_timeout,
      [self = shared_from_this(), id, &places](TlsHandshake::End end, std::unique_ptr<TlsStream> stream,
                                               const std::string&) {
        self->handshakes.erase(id);
        places.release(id);
        self->onHandshake(end, std::move(stream));
      },
      [self = shared_from_this(), id, peer, &places, hasty] {
        if (!self->judgeHello(places, id, peer)) return self->hangUp(places, id);
        if (hasty) self->handshakes.at(id)->setTimeout(self->tls.handshake_timeout / 2);
      });
}

void TcpListener::State::refuse(const tcp::endpoint& peer, StreamRefusal why) {
  ++(why == StreamRefusal::kBanned     ? counters.refused_banned
     : why == StreamRefusal::kTooOften ? counters.refused_too_often
     : why == StreamRefusal::kFull     ? counters.refused_half_open
                                       : counters.refused_from_prefix);
  if (tls.on_refused) tls.on_refused(peer, why);
}

// Checks the place first: a connection without a place does not count as a handshake.
bool TcpListener::State::judgeHello(HalfOpenLimit& places, HalfOpenLimit::Id id, const tcp::endpoint& peer) {
  if (!places.onHello(id)) {
    refuse(peer, StreamRefusal::kPrefixFull);
    return false;
  }
  if (!tls.try_handshake || tls.try_handshake(AddressPrefix::of(peer.address()))) return true;
  refuse(peer, StreamRefusal::kTooOften);
  return false;
}

void TcpListener::State::hangUp(HalfOpenLimit& places, HalfOpenLimit::Id id) {
  // A callback may have closed the listener.
  if (const auto ended = handshakes.extract(id)) ended.mapped()->cancel();
  places.release(id);
}

// Frees a place for a connection of this prefix if needed; false if that fails. Each iteration ends a silent
// connection, or finds that it has greeted or is gone.
bool TcpListener::State::makeRoom(HalfOpenLimit& places, const tcp::endpoint& peer) {
  using Kind = HalfOpenLimit::Result::Kind;
  const AddressPrefix prefix = AddressPrefix::of(peer.address());
  for (;;) {
    const HalfOpenLimit::Result verdict = places.check(prefix);
    if (verdict.kind == Kind::kFits) return acceptor.is_open();
    if (verdict.kind != Kind::kEvictFirst) {
      refuse(peer, verdict.kind == Kind::kFull ? StreamRefusal::kFull : StreamRefusal::kPrefixFull);
      return false;
    }
    const std::shared_ptr<TlsHandshake> handshake = handshakes.at(verdict.id);
    handshake->readAhead();  // because its hello may have arrived unread
    if (!places.isSilent(verdict.id)) continue;
    hangUp(places, verdict.id);
    ++counters.half_open_ended;
  }
}

void TcpListener::State::onHandshake(TlsHandshake::End end, std::unique_ptr<TlsStream> stream) {
  ++(end == TlsHandshake::End::kTimedOut ? counters.handshakes_late
     : stream == nullptr                 ? counters.handshakes_failed
                                         : counters.handshakes);
  if (stream != nullptr) on_channel(makeTcpChannel(std::move(stream), options));
}

void TcpListener::State::close() {
  stopAccepting();
  for (const auto& [id, handshake] : std::exchange(handshakes, {})) handshake->cancel();
}

TcpListener::TcpListener(asio::io_context& context, const std::string& address, std::uint16_t port,
                         OnChannel on_channel, TcpOptions options, TlsListenerOptions tls)
    : state_(std::make_shared<State>(context, std::move(on_channel), options, std::move(tls))) {
  state_->listen(address, port);
  state_->accept();
}

TcpListener::TcpListener(asio::io_context& context, int listening_socket, OnChannel on_channel,
                         TcpOptions options, TlsListenerOptions tls)
    : state_(std::make_shared<State>(context, std::move(on_channel), options, std::move(tls))) {
  state_->adoptListening(listening_socket);
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

const TcpListener::Counters& TcpListener::counters() const {
  return state_->counters;
}

std::size_t TcpListener::halfOpen() const {
  return state_->strangers.count() + state_->known.count();
}

void TcpListener::adopt(asio::generic::stream_protocol::socket socket, const tcp::endpoint& peer) {
  if (state_->acceptor.is_open() && state_->tls.context) state_->startHandshake(std::move(socket), peer);
}

void TcpListener::setTls(std::shared_ptr<const TlsContext> context) {
  if (state_->tls.context && context) state_->tls.context = std::move(context);
}

void TcpListener::close() {
  state_->close();
}

}  // namespace naiad
