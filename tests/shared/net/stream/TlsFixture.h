// A TLS listener and its clients.
#pragma once

#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/ssl.h>

#include <array>
#include <asio/write.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "shared/net/stream/TcpConnector.h"
#include "shared/net/stream/TcpListener.h"
#include "tests/shared/net/Loopback.h"
#include "tests/shared/net/Recorder.h"

namespace naiad::test {

/// Offers this ALPN name, or none if it is empty. May be called in RawTls's `adjust`.
inline void offerAlpn(SSL_CTX* context, std::string_view name) {
  const std::string list = name.empty() ? "" : static_cast<char>(name.size()) + std::string(name);
  SSL_CTX_set_alpn_protos(context, reinterpret_cast<const unsigned char*>(list.data()),
                          static_cast<unsigned int>(list.size()));
}

/// The client's end of a TLS connection with OpenSSL alone. The test chooses its settings and carries its
/// bytes.
class RawTls {
 public:
  /// Makes a client with ALPN "naiad/1" unless `adjust` changes that.
  explicit RawTls(const std::function<void(SSL_CTX*)>& adjust = nullptr)
      : m_context(SSL_CTX_new(TLS_client_method())) {
    offerAlpn(m_context, kAlpn);
    if (adjust) adjust(m_context);
    m_ssl = SSL_new(m_context);
    SSL_set_bio(m_ssl, BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
    SSL_set_connect_state(m_ssl);
  }
  ~RawTls() {
    SSL_free(m_ssl);
    SSL_CTX_free(m_context);
  }
  RawTls(const RawTls&) = delete;
  RawTls& operator=(const RawTls&) = delete;

  /// Continues the handshake. Returns the bytes to send next.
  std::string advance() {
    ERR_clear_error();
    if (!done()) m_result = SSL_do_handshake(m_ssl);
    m_failed = m_failed || (!done() && SSL_get_error(m_ssl, m_result) != SSL_ERROR_WANT_READ);
    std::string out(BIO_ctrl_pending(SSL_get_wbio(m_ssl)), '\0');
    if (!out.empty()) BIO_read(SSL_get_wbio(m_ssl), out.data(), static_cast<int>(out.size()));
    return out;
  }
  /// Reads what has arrived on `socket`. Returns the number of bytes, and the reason if it is 0.
  std::size_t receive(tcp::socket& socket, std::error_code& error) {
    std::array<char, 4096> in;
    const std::size_t size = socket.read_some(asio::buffer(in), error);
    BIO_write(SSL_get_rbio(m_ssl), in.data(), static_cast<int>(size));
    return size;
  }
  /// Exchanges bytes with a server on `socket` (made non-blocking) until the handshake succeeds or fails.
  void shakeHands(asio::io_context& context, tcp::socket& socket) {
    std::error_code error;
    socket.non_blocking(true);
    EXPECT_TRUE(runUntil(context, [&] {
      const std::string out = advance();
      if (!out.empty()) asio::write(socket, asio::buffer(out), error);
      receive(socket, error);
      const bool over = error && error != asio::error::would_block;
      if (over && !done()) m_failed = true;
      return done() || m_failed;
    }));
  }
  /// Receives on a non-blocking socket and decrypts up to `most` bytes. Returns their number, 0 or less if
  /// none.
  int read(tcp::socket& socket, char* bytes, int most) {
    std::error_code ignored;
    receive(socket, ignored);
    return SSL_read(m_ssl, bytes, most);
  }

  bool done() const { return m_result == 1; }
  bool failed() const { return m_failed; }
  SSL* ssl() const { return m_ssl; }

 private:
  SSL_CTX* m_context;
  SSL* m_ssl;
  int m_result = 0;
  bool m_failed = false;
};

/// Holds the result of a connector.
struct ConnectFixture : testing::Test {
  TcpConnector::Done done() {
    return [this](std::unique_ptr<ReliableChannel> made, const std::string& sentence) {
      channel = std::move(made);
      error = sentence;
      ++calls;
    };
  }
  bool runUntilDone() {
    return runUntil(context, [&] { return calls > 0; });
  }
  /// Connects and waits for the result. `where` is a port or a list of endpoints.
  template <class Where>
  void connect(TcpConnector& by, const std::string& host, const Where& where,
               std::chrono::milliseconds timeout = std::chrono::seconds(20)) {
    calls = 0;
    by.connect(host, where, timeout, done());
    EXPECT_EQ(calls, 0);
    EXPECT_TRUE(runUntilDone()) << host;
  }

  asio::io_context context;
  std::unique_ptr<ReliableChannel> channel;
  std::string error;
  int calls = 0;
};

struct TlsFixture : ConnectFixture {
  /// Accepts silent connections at once, so that tests need not wait for the kernel.
  TlsFixture() { tls.defer_accept = std::chrono::seconds(0); }
  void listen(const std::string& address = "127.0.0.1") {
    if (!tls.context) tls.context = testServerContext();
    listener = std::make_unique<TcpListener>(
        context, address, 0, [this](auto made) { accepted.push_back(std::move(made)); },
        TcpOptions{.receive_limit = kMaxServerFrame}, tls);
  }
  tcp::socket knock(const std::string& address = "127.0.0.1") {
    tcp::socket socket(context);
    socket.connect({asio::ip::make_address(address), listener->port()});
    return socket;
  }
  /// Connects from this address in 127/8.
  tcp::socket knockFrom(const std::string& own) {
    tcp::socket socket(context, tcp::endpoint(asio::ip::make_address(own), 0));
    socket.connect({asio::ip::make_address("127.0.0.1"), listener->port()});
    return socket;
  }
  std::vector<tcp::socket> knockTimes(int times) {
    std::vector<tcp::socket> sockets;
    for (int i = 0; i < times; ++i) sockets.push_back(knock());
    return sockets;
  }
  /// True if the server has closed the connection.
  static bool isOver(tcp::socket& socket) {
    std::error_code error;
    std::array<char, 4096> in;
    socket.non_blocking(true);
    while (socket.read_some(asio::buffer(in), error) > 0) {
    }
    return error != asio::error::would_block;
  }
  /// Connects like a client and waits until both ends have a channel.
  void join(const std::string& host = "127.0.0.1") {
    calls = 0;
    const std::size_t before = accepted.size();
    connector.connect(host, listener->port(), std::chrono::seconds(20), done());
    EXPECT_TRUE(runUntil(context, [&] { return calls > 0 && (!channel || accepted.size() > before); }));
    EXPECT_TRUE(channel) << error;
  }
  const TcpListener::Counters& counters() const { return listener->counters(); }

  TlsListenerOptions tls;
  std::unique_ptr<TcpListener> listener;
  std::vector<std::unique_ptr<ReliableChannel>> accepted;
  TcpConnector connector{context, {.receive_limit = kMaxServerFrame}, testClientContext()};
};

}  // namespace naiad::test
