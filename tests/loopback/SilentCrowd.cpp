#include "SilentCrowd.h"

#include <array>
#include <asio/ip/tcp.hpp>
#include <asio/steady_timer.hpp>
#include <asio/write.hpp>
#include <chrono>

#include "shared/net/stream/TcpConnector.h"
#include "shared/net/stream/TlsStream.h"
#include "tests/support/Sanitizers.h"

namespace naiad::test {

using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

/// Returns the ClientHello of our own client.
std::string clientHello() {
  asio::io_context context;
  tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  TcpConnector connector(context, {}, TlsContext::forClient());
  connector.connect("127.0.0.1", acceptor.local_endpoint().port(), 30s, [](auto, const auto&) {});
  tcp::socket socket(context);
  std::string hello(16'384, '\0');
  acceptor.async_accept(socket, [&](const std::error_code&) {
    socket.async_read_some(asio::buffer(hello), [&](const std::error_code&, std::size_t size) {
      hello.resize(size);
      connector.cancel();
      context.stop();
    });
  });
  context.run();
  return hello;
}

}  // namespace

struct SilentCrowd::One : std::enable_shared_from_this<One> {
  One(asio::io_context& context, std::atomic<std::uint64_t>& count, tcp::endpoint from, tcp::endpoint to,
      std::string bytes)
      : socket(context), timer(context), hung_up(count), own(from), server(to), words(std::move(bytes)) {}

  void come() {
    std::error_code ignored;
    socket.close(ignored);
    socket.open(tcp::v4());
    socket.bind(own);
    socket.async_connect(server, [self = shared_from_this()](const std::error_code& error) {
      if (error) return self->comeAgain();
      if (self->tls) return self->shakeHands();
      std::error_code late;
      if (!self->words.empty()) asio::write(self->socket, asio::buffer(self->words), late);
      self->wait();
    });
  }
  void shakeHands() {
    const auto handshake =
        std::make_shared<TlsHandshake>(std::make_unique<TlsStream>(std::move(socket), tls, "127.0.0.1"));
    handshake->run(30s, [self = shared_from_this()](TlsHandshake::End, auto made, const auto&) {
      if (!made) return self->noteEnd();
      self->stream = std::move(made);
      self->stream->socket().async_wait(  // waits for the end, as the server sends nothing
          tcp::socket::wait_read, [self](const std::error_code&) { self->noteEnd(); });
    });
  }
  void noteEnd() {
    ++hung_up;
    stream.reset();
    comeAgain();
  }
  void wait() {
    socket.async_read_some(asio::buffer(in),
                           [self = shared_from_this()](const std::error_code& error, std::size_t) {
                             if (!error) return self->wait();
                             self->noteEnd();
                           });
  }
  /// Reconnects after 200 ms (later with a sanitizer), so that the crowd makes a few hundred connections a
  /// second.
  void comeAgain() {
    timer.expires_after(kSlowness * 200ms);
    timer.async_wait([self = shared_from_this()](const std::error_code& error) {
      if (!error) self->come();
    });
  }

  tcp::socket socket;
  asio::steady_timer timer;
  std::atomic<std::uint64_t>& hung_up;
  tcp::endpoint own, server;
  std::string words;
  std::shared_ptr<const TlsContext> tls;  // null: no TLS handshake
  std::unique_ptr<TlsStream> stream;      // set after the handshake
  std::array<char, 4096> in{};
};

SilentCrowd::SilentCrowd(std::uint16_t server, const std::vector<std::string>& addresses, int each,
                         Kind kind) {
  const std::shared_ptr<const TlsContext> tls = kind == Kind::kNoHello ? TlsContext::forClient() : nullptr;
  std::string words = kind == Kind::kSilent || tls ? "" : clientHello();
  if (kind == Kind::kBegunHello) words.resize(words.size() / 2);
  const tcp::endpoint to(asio::ip::address_v4::loopback(), server);
  for (int i = 0; i < each; ++i) {
    for (const std::string& address : addresses) {
      m_all.push_back(std::make_shared<One>(m_context, m_hung_up,
                                            tcp::endpoint(asio::ip::make_address(address), 0), to, words));
      m_all.back()->tls = tls;
    }
  }
  m_thread = std::thread([this] {
    for (const auto& one : m_all) one->come();
    m_context.run();
  });
}

SilentCrowd::~SilentCrowd() {
  m_context.stop();
  m_thread.join();
  m_all.clear();
}

}  // namespace naiad::test
