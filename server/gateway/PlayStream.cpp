#include "server/gateway/PlayStream.h"

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
/// Send buffer towards a browser in bytes, including data in flight. A new snapshot may have to wait behind
/// it. Enough for 300 kB/s at a round trip of 200 ms.
constexpr int kSendBuffer = 32 * 1024;
/// Rate limit of pings and unsolicited pongs; browsers send none.
constexpr BucketRate kControls{1, 16};
/// Available messages of a browser are sent to the server together, up to this many bytes.
constexpr std::size_t kMaxGathered = 2048;
/// Space behind the largest message: Beast needs some to read an empty last fragment.
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

PlayStream::PlayStream(GatewayState& gateway, SecureSocket socket, VisitorFacts visitor,
                       Newcomers::Place place)
    : Guest(gateway.sharedGuests()),
      m_gateway(gateway),
      m_socket(std::move(socket)),
      m_visitor(std::move(visitor)),
      m_newcomer(std::move(place)),
      m_up(kMaxClientFrame + kSlack),
      m_frames(kMaxServerFrame) {}

void PlayStream::accept(const WebRequest& request) {
  m_gateway.newcomers.replace(m_newcomer, [weak = std::weak_ptr(sharedFrom(this))] {
    if (const auto self = weak.lock()) self->hangUp();
  });
  prepareSocket();
  setTime(m_gateway.settings.hello_time);
  m_socket.async_accept(request, [self = sharedFrom(this)](error_code error) {
    if (self->isOver()) return;
    if (error) return self->hangUp();
    ++self->m_gateway.counters.websockets;
    self->m_phase == Phase::kHello ? self->readUp() : self->sendClose();
  });
}

void PlayStream::prepareSocket() {
  SecureSocket& socket = m_socket.next_layer();
  // Small buffers from now on, because queued snapshots get old. Files were sent with the kernel's defaults.
  setNumber(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  setNumber(socket, IPPROTO_TCP, TCP_NOTSENT_LOWAT, static_cast<int>(kMaxUnsent));
  setNumber(socket, SOL_SOCKET, SO_SNDBUF, kSendBuffer);
  // No timeouts of Beast, because it resets a timer for each message. onSweep() is cheaper.
  m_socket.set_option(
      websocket::stream_base::timeout{websocket::stream_base::none(), websocket::stream_base::none(), false});
  m_socket.set_option(websocket::stream_base::decorator([this](websocket::response_type& response) {
    for (const auto& [name, value] : m_gateway.answers.commonHeaders())
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

/// Limits control frames, because pings need answers. Closes only the socket: the pending read ends the rest.
void PlayStream::onControl(websocket::frame_type kind) {
  noteLife();
  if (kind == websocket::frame_type::close ||
      m_controls.takeToken(kControls, std::chrono::steady_clock::now()))
    return;
  ++m_gateway.counters.control_floods;
  m_socket.next_layer().close();
}

void PlayStream::noteLife() {
  m_is_pinged = false;
  m_ping_at = std::chrono::steady_clock::now() + m_gateway.settings.ping_time;
}

void PlayStream::onSweep(Time now) {
  Guest::onSweep(now);
  if (now < m_ping_at || m_phase == Phase::kClosing || isOver()) return;
  if (!m_is_pinged) return ping();
  ++m_gateway.counters.gone_silent;
  hangUp();
}

void PlayStream::ping() {
  noteLife();  // the answer must come within ping_time, too
  m_is_pinged = true;
  if (std::exchange(m_ping_waits, true)) return;
  m_socket.async_ping({}, [self = sharedFrom(this)](error_code) { self->m_ping_waits = false; });
}

// Browser to server.

void PlayStream::readUp() {
  noteLife();
  m_is_reading_up = true;
  m_up.clear();
  m_socket.async_read(m_up, [self = sharedFrom(this)](error_code error, std::size_t size) {
    if (self->m_phase != Phase::kClosing && !self->isOver()) self->onUp(error, size);
  });
}

void PlayStream::onUp(error_code error, std::size_t size) {
  m_is_reading_up = false;
  m_ping_at = Time::max();  // no pings while nothing is read, because no answer could be seen
  if (error) {
    if (error != websocket::error::closed &&
        error.category() == websocket::make_error_code(websocket::error::closed).category())
      ++m_gateway.counters.bad_messages;
    return hangUp();
  }
  if (!m_socket.got_binary() || size == 0) {
    ++m_gateway.counters.bad_messages;
    return m_socket.got_binary() ? close(PlayClose::kPolicy, "Empty messages are not allowed.")
                                 : close(PlayClose::kNotBinary, "Only binary messages are allowed.");
  }
  ++m_gateway.counters.messages_up;
  if (m_phase == Phase::kHello) return openLink();
  putUp();
  gatherUp();
}

void PlayStream::openLink() {
  m_place = m_gateway.places.take(m_visitor.prefix);
  if (!m_place) {
    ++m_gateway.counters.full;
    return close(PlayClose::kFull, "All places, or those for your address, are taken. Try again later.");
  }
  m_newcomer = {};
  m_phase = Phase::kOpening;
  m_socket.read_message_max(kMaxClientFrame);
  setTime(m_gateway.settings.open_time);
  m_link = std::make_shared<GameLink>(m_socket.get_executor(), m_gateway.server);
  m_link->open(m_visitor.header, [self = sharedFrom(this)](GameLink::End end, const std::string& problem) {
    self->onLink(end, problem);
  });
}

void PlayStream::onLink(GameLink::End end, const std::string& problem) {
  if (m_phase != Phase::kOpening) return;
  if (end == GameLink::End::kOpen) {
    ++m_gateway.counters.played;
    m_phase = Phase::kPlaying;
    setNoTime();
    putUp();
    if (flushUp()) readUp();
    return readDown();
  }
  m_gateway.log.logNews(m_visitor.name, "cannot join: " + problem, std::chrono::steady_clock::now());
  if (end == GameLink::End::kUnreachable) return closeWithoutServer();
  ++m_gateway.counters.wrong_keys;
  close(PlayClose::kWrongKey, "Wrong server key: this page belongs to another server.");
}

/// Queues the browser's message for the server as a frame.
void PlayStream::putUp() {
  std::array<char, kFrameHeaderSize> header{};
  writeFrameHeader(header, m_up.size());
  m_link->stream().put({header.data(), header.size()});
  m_link->stream().put({static_cast<const char*>(m_up.data().data()), m_up.size()});
}

/// Delays the write while further messages are available: they are handled before the job posted here.
void PlayStream::gatherUp() {
  if (m_server_waits || (m_link->stream().keptBytes() > kMaxGathered && !flushUp())) return;
  readUp();
  m_has_gathered = true;
  if (std::exchange(m_is_gathering, true)) return;
  m_has_gathered = false;
  boost::asio::post(m_socket.get_executor(), [self = sharedFrom(this)] { self->onGathered(); });
}

void PlayStream::onGathered() {
  if (m_phase != Phase::kPlaying) return;
  if (std::exchange(m_has_gathered, false))
    return boost::asio::post(m_socket.get_executor(), [self = sharedFrom(this)] { self->onGathered(); });
  m_is_gathering = false;
  if (!m_server_waits) flushUp();
}

/// Returns true if all data was sent. Else continues when the server has read, then reads the browser again.
bool PlayStream::flushUp() {
  SecureSocket& stream = m_link->stream();
  ++m_gateway.counters.writes_up;
  const bool is_there = stream.flush();
  if (is_there && stream.keptBytes() == 0) return true;
  m_server_waits = true;
  if (!is_there) return false;  // the pending read of the server reports the end
  stream.asyncWaitForRoom([self = sharedFrom(this)](error_code error) {
    if (error || self->m_phase != Phase::kPlaying) return;
    self->m_server_waits = false;
    if (self->flushUp() && !self->m_is_reading_up) self->readUp();
  });
  return false;
}

// Server to browser.

void PlayStream::readDown() {
  m_link->stream().async_read_some(boost::asio::buffer(m_down),
                                   [self = sharedFrom(this)](error_code error, std::size_t size) {
                                     if (self->m_phase == Phase::kPlaying) self->onDown(error, size);
                                   });
}

void PlayStream::onDown(error_code error, std::size_t size) {
  if (!error) {
    m_frames.feed({m_down.data(), size});
    setTime(m_gateway.settings.stall_time);
    return writeDown();
  }
  if (error != boost::asio::error::eof || m_frames.midFrame()) return closeWithoutServer();
  close(PlayClose::kEnded, "The game's server closed the connection.");
}

void PlayStream::writeDown() {
  if (!m_socket.is_open()) return;  // Beast is closing it; the pending read reports the end
  SecureSocket& socket = m_socket.next_layer();
  while (const auto frame = m_frames.next()) {
    ++m_gateway.counters.messages_down;
    putMessage(socket, *frame);
  }
  if (socket.keptBytes() > 0) ++m_gateway.counters.writes_down;
  m_frames.error() == FrameError::kNone ? awaitRoom() : closeWithoutServer();
}

void PlayStream::awaitRoom() {
  SecureSocket& socket = m_socket.next_layer();
  if (!socket.flush()) return hangUp();
  if (socket.keptBytes() == 0 && !socket.hasUnsent(kMaxUnsent)) {
    setNoTime();
    return readDown();
  }
  socket.asyncWaitForRoom([self = sharedFrom(this)](error_code error) {
    if (self->m_phase != Phase::kPlaying) return;
    error ? self->hangUp() : self->awaitRoom();
  });
}

// The end.

void PlayStream::onDeadline() {
  switch (m_phase) {
    case Phase::kHello:
      ++m_gateway.counters.late;
      return close(PlayClose::kPolicy, "No hello message arrived in time.");
    case Phase::kOpening:
      return closeWithoutServer();
    case Phase::kPlaying:
      ++m_gateway.counters.too_slow;
      return close(PlayClose::kTooSlow, "Disconnected: your connection is too slow.");
    case Phase::kClosing:
    case Phase::kOver:
      return hangUp();
  }
}

void PlayStream::closeWithoutServer() {
  ++m_gateway.counters.unreachable;
  close(PlayClose::kUnreachable, "The game's server cannot be reached.");
}

void PlayStream::endService() {
  close(PlayClose::kGoingAway, "The gateway is shutting down.");
}

void PlayStream::close(PlayClose code, std::string_view reason) {
  if (m_phase == Phase::kClosing || isOver()) return;
  m_phase = Phase::kClosing;
  setTime(m_gateway.settings.close_time);
  if (m_link) m_link->close();
  m_close.code = static_cast<std::uint16_t>(code);
  m_close.reason.assign(reason.begin(), reason.end());
  if (m_socket.is_open()) sendClose();  // else accept() does it after the upgrade
}

void PlayStream::sendClose() {
  if (std::exchange(m_close_sent, true)) return;
  m_socket.async_close(m_close, [self = sharedFrom(this)](error_code) { self->hangUp(); });
}

void PlayStream::hangUp() {
  m_phase = Phase::kOver;
  setNoTime();
  if (m_link) m_link->close();
  m_socket.next_layer().close();
  m_newcomer = {};
  m_place = {};
}

}  // namespace naiad
