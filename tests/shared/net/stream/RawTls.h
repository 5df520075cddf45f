// One end of a TLS connection with OpenSSL alone. The test chooses its settings and carries its bytes.
#pragma once

#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include <functional>
#include <string>
#include <string_view>

#include "tests/shared/net/Loopback.h"

namespace naiad::test {

class RawTls {
 public:
  /// Makes a client with ALPN "naiad/1" unless `adjust` changes that.
  explicit RawTls(const std::function<void(SSL_CTX*)>& adjust = nullptr);
  ~RawTls();
  RawTls(const RawTls&) = delete;
  RawTls& operator=(const RawTls&) = delete;

  /// Continues the handshake. Returns the bytes to send next.
  std::string advance();
  void feed(std::string_view bytes);
  /// Exchanges bytes with a server on `socket` (made non-blocking) until the handshake succeeds or fails.
  void shakeHands(asio::io_context& context, tcp::socket& socket);

  bool done() const { return result_ == 1; }
  bool failed() const { return failed_; }
  SSL* ssl() const { return ssl_; }

 private:
  SSL_CTX* context_;
  SSL* ssl_;
  int result_ = 0;
  bool failed_ = false;
};

/// Offers this ALPN name, or none if it is empty. May be called in RawTls's `adjust`.
void offerAlpn(SSL_CTX* context, std::string_view name);

}  // namespace naiad::test
