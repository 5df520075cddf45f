#include "client/session/WebSocket.h"

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <deque>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "shared/net/base/Limits.h"
#include "shared/net/base/WebDoor.h"

namespace naiad {

namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using beast::error_code;
using boost::asio::ip::tcp;
// The executor by its type: calls through it are direct, and half as much is compiled.
using Executor = boost::asio::io_context::executor_type;
using PlainStream = beast::basic_stream<tcp, Executor>;
using EncryptedStream = beast::ssl_stream<PlainStream>;

struct WebSocketThread::Loop {
  boost::asio::io_context context{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work{context.get_executor()};
  boost::asio::ssl::context tls{boost::asio::ssl::context::tls_client};
  std::thread thread;
};

namespace {

constexpr std::chrono::seconds kOpenTimeout{10};

beast::string_view text(std::string_view view) {
  return {view.data(), view.size()};
}

/// Members that begin with "run" belong to the sockets' thread.
template <class Stream>
class SocketOf : public WebSocket, public std::enable_shared_from_this<SocketOf<Stream>> {
 public:
  template <class... Arguments>
  SocketOf(WebSocketThread::Loop& loop, GatewayAddress address, Events events, Arguments&... arguments)
      : m_loop(loop),
        m_address(std::move(address)),
        m_events(std::move(events)),
        m_resolver(loop.context),
        m_stream(loop.context, arguments...) {}

  void open() {
    boost::asio::post(m_loop.context, [self = self()] { self->runOpen(); });
  }
  void send(std::string frame) override {
    m_unsent += frame.size();
    boost::asio::post(m_loop.context, [self = self(), frame = std::move(frame)]() mutable {
      if (self->m_ended) return;
      self->m_queue.push_back(std::move(frame));
      if (self->m_open && self->m_queue.size() == 1) self->runWrite();
    });
  }
  void close() override {
    boost::asio::post(m_loop.context, [self = self()] { self->runClose(); });
  }
  std::size_t unsentBytes() const override { return m_unsent; }

 private:
  static constexpr bool kEncrypted = std::is_same_v<Stream, EncryptedStream>;

  std::shared_ptr<SocketOf> self() { return this->shared_from_this(); }

  void runOpen() {
    m_resolver.async_resolve(
        m_address.host, std::to_string(m_address.port),
        [self = self()](error_code error, const auto& results) {
          if (error) return self->runFail("The host of the gateway was not found (" + error.message() + ").");
          std::vector<tcp::endpoint> addresses;
          for (const auto& result : results) {
            if (kEncrypted || result.endpoint().address().is_loopback())
              addresses.push_back(result.endpoint());
          }
          if (addresses.empty())
            return self->runFail(
                "Without encryption (https) only gateways on this machine are connected to.");
          auto& lowest = beast::get_lowest_layer(self->m_stream);
          lowest.expires_after(kOpenTimeout);
          lowest.async_connect(addresses, [self](error_code failed, const tcp::endpoint&) {
            if (failed) return self->runFail("The gateway cannot be reached (" + failed.message() + ").");
            beast::get_lowest_layer(self->m_stream).socket().set_option(tcp::no_delay(true));
            self->runEncrypt();
          });
        });
  }

  void runEncrypt() {
    if constexpr (kEncrypted) {
      auto& tls = m_stream.next_layer();
      error_code is_name;
      boost::asio::ip::make_address(m_address.host, is_name);
      if (is_name) SSL_set_tlsext_host_name(tls.native_handle(), m_address.host.c_str());  // RFC 6066 3
      tls.set_verify_callback(boost::asio::ssl::host_name_verification(m_address.host));
      tls.async_handshake(boost::asio::ssl::stream_base::client, [self = self()](error_code error) {
        if (error) return self->runFail("The gateway is not trusted (" + error.message() + ").");
        self->runUpgrade();
      });
    } else {
      runUpgrade();
    }
  }

  void runUpgrade() {
    beast::get_lowest_layer(m_stream).expires_never();
    m_stream.set_option(websocket::stream_base::timeout::suggested(beast::role_type::client));
    m_stream.set_option(
        websocket::stream_base::decorator([origin = m_address.origin()](websocket::request_type& request) {
          request.set(beast::http::field::origin, origin);
          request.set(beast::http::field::sec_websocket_protocol, text(kSubprotocol));
        }));
    m_stream.read_message_max(kMaxServerFrame);
    m_stream.binary(true);
    m_stream.async_handshake(m_address.hostText(), text(kPlayPath), [self = self()](error_code error) {
      if (error) return self->runFail("The gateway refused (" + error.message() + ").");
      self->m_open = true;
      if (self->m_closing) return self->runClose();
      self->m_events.on_open("");
      if (!self->m_queue.empty()) self->runWrite();
      self->runRead();
    });
  }

  void runRead() {
    m_stream.async_read(m_buffer, [self = self()](error_code error, std::size_t) {
      if (error) return self->runEnd(error);
      if (!self->m_closing) self->m_events.on_frame(beast::buffers_to_string(self->m_buffer.data()));
      self->m_buffer.clear();
      self->runRead();
    });
  }

  void runWrite() {
    m_stream.async_write(boost::asio::buffer(m_queue.front()),
                         [self = self()](error_code error, std::size_t) {
                           if (error) return self->runEnd(error);
                           if (self->m_ended) return;
                           self->m_unsent -= self->m_queue.front().size();
                           self->m_queue.pop_front();
                           if (!self->m_queue.empty()) return self->runWrite();
                           if (self->m_closing) self->runClose();
                         });
  }

  void runClose() {
    m_closing = true;
    if (!m_open) {
      error_code ignored;
      m_resolver.cancel();
      beast::get_lowest_layer(m_stream).socket().close(ignored);
      return;
    }
    if (!m_queue.empty()) return;  // runWrite() comes back
    m_open = false;
    m_stream.async_close(websocket::close_code::normal, [self = self()](error_code) {});
  }

  void runEnd(error_code error) {
    // Reading and writing both end; the frame that is being written stays until its write has.
    if (std::exchange(m_ended, true)) return;
    m_open = false;
    const bool ordered = error == websocket::error::closed &&
                         m_stream.reason().code == static_cast<std::uint16_t>(PlayClose::kEnded);
    if (!m_closing) m_events.on_closed(ordered);
  }

  void runFail(const std::string& sentence) {
    if (!m_closing) m_events.on_open(sentence);
  }

  WebSocketThread::Loop& m_loop;
  GatewayAddress m_address;
  Events m_events;
  boost::asio::ip::basic_resolver<tcp, Executor> m_resolver;
  websocket::stream<Stream, false> m_stream;  // without compression, which dfweb does not offer
  beast::flat_buffer m_buffer;
  std::deque<std::string> m_queue;
  std::atomic<std::size_t> m_unsent{0};
  bool m_open = false;
  bool m_ended = false;
  bool m_closing = false;
};

}  // namespace

WebSocketThread::WebSocketThread() : m_loop(std::make_unique<Loop>()) {
  m_loop->tls.set_default_verify_paths();
  m_loop->tls.set_verify_mode(boost::asio::ssl::verify_peer);
  m_loop->thread = std::thread([loop = m_loop.get()] { loop->context.run(); });
}

std::shared_ptr<WebSocketThread> WebSocketThread::common() {
  static std::weak_ptr<WebSocketThread> held;
  auto thread = held.lock();
  if (!thread) held = thread = std::make_shared<WebSocketThread>();
  return thread;
}

WebSocketThread::~WebSocketThread() {
  m_loop->context.stop();
  m_loop->thread.join();
}

std::shared_ptr<WebSocket> WebSocket::open(WebSocketThread& thread, const GatewayAddress& address,
                                           Events events) {
  WebSocketThread::Loop& loop = thread.loop();
  if (address.encrypted) {
    const auto socket =
        std::make_shared<SocketOf<EncryptedStream>>(loop, address, std::move(events), loop.tls);
    socket->open();
    return socket;
  }
  const auto socket = std::make_shared<SocketOf<PlainStream>>(loop, address, std::move(events));
  socket->open();
  return socket;
}

}  // namespace naiad
