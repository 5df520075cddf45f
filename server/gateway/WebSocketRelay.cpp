#include "server/gateway/WebSocketRelay.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <boost/asio/post.hpp>
#include <boost/beast/websocket/error.hpp>
#include <utility>

#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

namespace websocket = boost::beast::websocket;

constexpr std::size_t kMaxUnsent = 4096;  // the server is read only while at most this many bytes are unsent
/// Send buffer towards a browser in bytes, including data in flight (the kernel doubles it): small, because a
/// new snapshot may have to wait behind these bytes, but enough for 300 kB/s at a round trip of 200 ms.
constexpr int kSendBuffer = 32 * 1024;
/// Rate limit of pings and unsolicited pongs; browsers send none.
constexpr BucketRate kControls{1, 16};
/// Available messages of a browser are sent to the server together, up to this many bytes.
constexpr std::size_t kMaxBatch = 2048;
/// Bytes of the read buffer beyond the largest message, which Beast needs to read an empty last fragment.
constexpr std::size_t kSlack = 64;

/// Queues a binary message of one frame, unmasked as required for servers (RFC 6455 5.2).
void putMessage(SecureSocket& socket, std::string_view payload) {
  constexpr std::size_t kMaxShort = 125;
  constexpr char kTwoBytes = 126;  // two bytes of length follow
  static_assert(kMaxServerFrame <= 0xffff);
  std::array<char, 4> header{static_cast<char>(0x82)};  // final, binary
  const bool is_short = payload.size() <= kMaxShort;
  header[1] = is_short ? static_cast<char>(payload.size()) : kTwoBytes;
  header[2] = static_cast<char>(payload.size() >> 8);
  header[3] = static_cast<char>(payload.size() & 0xff);
  socket.put({header.data(), is_short ? std::size_t{2} : header.size()});
  socket.put(payload);
}

void setNumber(SecureSocket& socket, int level, int name, int value) {
  setsockopt(socket.socket().native_handle(), level, name, &value, sizeof value);
}

}  // namespace

WebSocketRelay::WebSocketRelay(GatewayState& gateway, SecureSocket socket, ProxiedPeer visitor,
                               PendingConnections::Slot slot)
    : GatewayConnection(gateway.sharedConnections()),
      m_gateway(gateway),
      m_socket(std::move(socket)),
      m_visitor(std::move(visitor)),
      m_pending_slot(std::move(slot)),
      m_up(kMaxClientFrame + kSlack),
      m_frames(kMaxServerFrame) {}

void WebSocketRelay::accept(const WebRequest& request) {
  m_gateway.pending.replace(m_pending_slot, [weak = std::weak_ptr(sharedFrom(this))] {
    if (const auto self = weak.lock()) self->disconnect();
  });
  prepareSocket();
  setDeadline(m_gateway.settings.hello_timeout);
  m_socket.async_accept(request, [self = sharedFrom(this)](error_code error) {
    if (self->isOver()) return;
    if (error) return self->disconnect();
    ++self->m_gateway.counters.websockets;
    self->m_phase == Phase::kHello ? self->readUp() : self->sendClose();
  });
}

void WebSocketRelay::prepareSocket() {
  SecureSocket& socket = m_socket.next_layer();
  // Small buffers from now on, because queued snapshots get old. Files were sent with the kernel's defaults.
  setNumber(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  setNumber(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, static_cast<int>(kMaxUnsent));
  setNumber(socket, SOL_SOCKET, SO_SNDBUF, kSendBuffer);
  // No timeouts of Beast, because it resets a timer for each message. onSweep() is cheaper.
  m_socket.set_option(
      websocket::stream_base::timeout{websocket::stream_base::none(), websocket::stream_base::none(), false});
  m_socket.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
    for (const auto& [name, value] : m_gateway.responses.commonHeaders())
      response.set(boost::beast::string_view(name.data(), name.size()),
                   boost::beast::string_view(value.data(), value.size()));
    response.set(boost::beast::http::field::server, "dfweb");  // instead of Beast's name
    if (response.result() == boost::beast::http::status::switching_protocols)
      response.set(boost::beast::http::field::sec_websocket_protocol,
                   boost::beast::string_view(kSubprotocol.data(), kSubprotocol.size()));
  }));
  m_socket.read_message_max(kMaxHelloFrame);
  m_socket.binary(true);
  m_socket.auto_fragment(false);
  m_socket.control_callback(
      [this](websocket::frame_type kind, boost::beast::string_view) { onControl(kind); });
}

/// Limits control frames, because pings need responses. Closes only the socket: the pending read then fails
/// and ends the relay.
void WebSocketRelay::onControl(websocket::frame_type kind) {
  onActivity();
  if (kind == websocket::frame_type::close ||
      m_controls.tryConsume(kControls, std::chrono::steady_clock::now()))
    return;
  ++m_gateway.counters.control_floods;
  m_socket.next_layer().close();
}

void WebSocketRelay::onActivity() {
  m_is_pinged = false;
  m_ping_at = std::chrono::steady_clock::now() + m_gateway.settings.ping_interval;
}

void WebSocketRelay::onSweep(Time now) {
  GatewayConnection::onSweep(now);
  if (now < m_ping_at || m_phase == Phase::kClosing || isOver()) return;
  if (!m_is_pinged) return ping();
  ++m_gateway.counters.ping_timeouts;
  disconnect();
}

void WebSocketRelay::ping() {
  onActivity();  // starts another ping_interval, within which the browser must answer
  m_is_pinged = true;
  if (std::exchange(m_ping_waits, true)) return;
  m_socket.async_ping({}, [self = sharedFrom(this)](error_code) { self->m_ping_waits = false; });
}

// Browser to server.

void WebSocketRelay::readUp() {
  onActivity();
  m_is_reading_up = true;
  m_up.clear();
  m_socket.async_read(m_up, [self = sharedFrom(this)](error_code error, std::size_t size) {
    if (self->m_phase != Phase::kClosing && !self->isOver()) self->onUp(error, size);
  });
}

void WebSocketRelay::onUp(error_code error, std::size_t size) {
  m_is_reading_up = false;
  m_ping_at = Time::max();  // no pings while nothing is read, because no answer could be seen
  if (error) {
    if (error != websocket::error::closed &&
        error.category() == websocket::make_error_code(websocket::error::closed).category())
      ++m_gateway.counters.bad_messages;
    return disconnect();
  }
  if (!m_socket.got_binary() || size == 0) {
    ++m_gateway.counters.bad_messages;
    return m_socket.got_binary() ? close(GatewayCloseCode::kPolicy, "Empty messages are not allowed.")
                                 : close(GatewayCloseCode::kNotBinary, "Only binary messages are allowed.");
  }
  ++m_gateway.counters.messages_up;
  if (m_phase == Phase::kHello) return openLink();
  queueUp();
  batchUp();
}

void WebSocketRelay::openLink() {
  m_slot = m_gateway.places.acquire(m_visitor.prefix);
  if (!m_slot) {
    ++m_gateway.counters.full;
    return close(GatewayCloseCode::kFull,
                 "All places, or those for your address, are taken. Try again later.");
  }
  m_pending_slot = {};
  m_phase = Phase::kOpening;
  m_socket.read_message_max(kMaxClientFrame);
  setDeadline(m_gateway.settings.connect_timeout);
  m_link = std::make_shared<UpstreamLink>(m_socket.get_executor(), m_gateway.server);
  m_link->open(m_visitor.header,
               [self = sharedFrom(this)](UpstreamLink::End end, const std::string& problem) {
                 self->onLinkAttemptEnd(end, problem);
               });
}

void WebSocketRelay::onLinkAttemptEnd(UpstreamLink::End end, const std::string& problem) {
  if (m_phase != Phase::kOpening) return;
  if (end == UpstreamLink::End::kOpen) {
    ++m_gateway.counters.played;
    m_phase = Phase::kPlaying;
    clearDeadline();
    queueUp();
    if (flushUp()) readUp();
    return readDown();
  }
  m_gateway.log.logClientEvent(m_visitor.name, "cannot join: " + problem, std::chrono::steady_clock::now());
  if (end == UpstreamLink::End::kUnreachable) return closeWithoutServer();
  if (end == UpstreamLink::End::kDropped)
    return closeWithoutServer(
        "The game's server closed the connection: your address may be banned, or no Naiad server runs "
        "there.");
  ++m_gateway.counters.wrong_keys;
  close(GatewayCloseCode::kWrongKey, "Wrong server key: this page belongs to another server.");
}

/// Queues the browser's message for the server as a frame.
void WebSocketRelay::queueUp() {
  std::array<char, kFrameHeaderSize> header{};
  writeFrameHeader(header, m_up.size());
  m_link->stream().put({header.data(), header.size()});
  m_link->stream().put({static_cast<const char*>(m_up.data().data()), m_up.size()});
}

/// Delays the write while further messages are available: they are handled before the job posted here.
void WebSocketRelay::batchUp() {
  if (m_server_blocked || (m_link->stream().queuedBytes() > kMaxBatch && !flushUp())) return;
  readUp();
  m_batch_grew = true;
  if (std::exchange(m_is_batching, true)) return;
  m_batch_grew = false;
  boost::asio::post(m_socket.get_executor(), [self = sharedFrom(this)] { self->flushBatch(); });
}

void WebSocketRelay::flushBatch() {
  if (m_phase != Phase::kPlaying) return;
  if (std::exchange(m_batch_grew, false))
    return boost::asio::post(m_socket.get_executor(), [self = sharedFrom(this)] { self->flushBatch(); });
  m_is_batching = false;
  if (!m_server_blocked) flushUp();
}

/// Returns true if all data was sent. Else sends the rest when the server accepts it, then reads the browser
/// again.
bool WebSocketRelay::flushUp() {
  SecureSocket& stream = m_link->stream();
  ++m_gateway.counters.writes_up;
  const bool is_there = stream.flush();
  if (is_there && stream.queuedBytes() == 0) return true;
  m_server_blocked = true;
  if (!is_there) return false;  // the pending read of the server reports the end
  stream.asyncWaitWritable([self = sharedFrom(this)](error_code error) {
    if (error || self->m_phase != Phase::kPlaying) return;
    self->m_server_blocked = false;
    if (self->flushUp() && !self->m_is_reading_up) self->readUp();
  });
  return false;
}

// Server to browser.

void WebSocketRelay::readDown() {
  m_link->stream().async_read_some(boost::asio::buffer(m_down),
                                   [self = sharedFrom(this)](error_code error, std::size_t size) {
                                     if (self->m_phase == Phase::kPlaying) self->onDown(error, size);
                                   });
}

void WebSocketRelay::onDown(error_code error, std::size_t size) {
  if (!error) {
    m_frames.feed({m_down.data(), size});
    setDeadline(m_gateway.settings.stall_timeout);
    return writeDown();
  }
  if (error != boost::asio::error::eof || m_frames.midFrame()) return closeWithoutServer();
  close(GatewayCloseCode::kEnded, "The game's server closed the connection.");
}

void WebSocketRelay::writeDown() {
  if (!m_socket.is_open()) return;  // Beast is closing it; the pending read reports the end
  SecureSocket& socket = m_socket.next_layer();
  while (const auto frame = m_frames.next()) {
    ++m_gateway.counters.messages_down;
    putMessage(socket, *frame);
  }
  if (socket.queuedBytes() > 0) ++m_gateway.counters.writes_down;
  m_frames.error() == FrameError::kNone ? awaitWritable() : closeWithoutServer();
}

void WebSocketRelay::awaitWritable() {
  SecureSocket& socket = m_socket.next_layer();
  if (!socket.flush()) return disconnect();
  if (socket.queuedBytes() == 0 && !socket.hasUnsent(kMaxUnsent)) {
    clearDeadline();
    return readDown();
  }
  socket.asyncWaitWritable([self = sharedFrom(this)](error_code error) {
    if (self->m_phase != Phase::kPlaying) return;
    error ? self->disconnect() : self->awaitWritable();
  });
}

// The end.

void WebSocketRelay::onDeadline() {
  switch (m_phase) {
    case Phase::kHello:
      ++m_gateway.counters.timeouts;
      return close(GatewayCloseCode::kPolicy, "No hello message arrived in time.");
    case Phase::kOpening:
      return closeWithoutServer();
    case Phase::kPlaying:
      ++m_gateway.counters.stalled;
      return close(GatewayCloseCode::kTooSlow, "Disconnected: your connection is too slow.");
    case Phase::kClosing:
    case Phase::kOver:
      return disconnect();
  }
}

void WebSocketRelay::closeWithoutServer(std::string_view reason) {
  ++m_gateway.counters.unreachable;
  close(GatewayCloseCode::kUnreachable, reason);
}

void WebSocketRelay::shutDown() {
  close(GatewayCloseCode::kGoingAway, "The gateway is shutting down.");
}

void WebSocketRelay::close(GatewayCloseCode code, std::string_view reason) {
  if (m_phase == Phase::kClosing || isOver()) return;
  m_phase = Phase::kClosing;
  setDeadline(m_gateway.settings.close_timeout);
  if (m_link) m_link->close();
  m_close.code = static_cast<std::uint16_t>(code);
  m_close.reason.assign(reason.begin(), reason.end());
  if (m_socket.is_open()) sendClose();  // else accept() does it after the upgrade
}

void WebSocketRelay::sendClose() {
  if (std::exchange(m_close_sent, true)) return;
  m_socket.async_close(m_close, [self = sharedFrom(this)](error_code) { self->disconnect(); });
}

void WebSocketRelay::disconnect() {
  m_phase = Phase::kOver;
  clearDeadline();
  if (m_link) m_link->close();
  m_socket.next_layer().close();
  m_pending_slot = {};
  m_slot = {};
}

}  // namespace naiad
