// One end of TLS that OpenSSL plays by itself, with settings of the test's choice and its bytes in the test's
// hands.
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
  /// A client with ALPN "naiad/1", unless `adjust` changes that.
  explicit RawTls(const std::function<void(SSL_CTX*)>& adjust = nullptr);
  ~RawTls();
  RawTls(const RawTls&) = delete;
  RawTls& operator=(const RawTls&) = delete;

  /// Go on; what it wants to send next.
  std::string advance();
  void feed(std::string_view bytes);
  /// Exchange with a server on `socket` (made non-blocking) until the handshake ends one way or the other.
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

/// For RawTls: no ALPN at all, or another one.
void offerAlpn(SSL_CTX* context, std::string_view name);

}  // namespace naiad::test
