#include "RawTls.h"

#include <openssl/err.h>

#include <array>
#include <asio/write.hpp>

namespace naiad::test {

RawTls::RawTls(const std::function<void(SSL_CTX*)>& adjust) : context_(SSL_CTX_new(TLS_client_method())) {
  offerAlpn(context_, kAlpn);
  if (adjust) adjust(context_);
  ssl_ = SSL_new(context_);
  SSL_set_bio(ssl_, BIO_new(BIO_s_mem()), BIO_new(BIO_s_mem()));
  SSL_set_connect_state(ssl_);
}

RawTls::~RawTls() {
  SSL_free(ssl_);
  SSL_CTX_free(context_);
}

std::string RawTls::advance() {
  ERR_clear_error();
  if (!done()) result_ = SSL_do_handshake(ssl_);
  failed_ = failed_ || (!done() && SSL_get_error(ssl_, result_) != SSL_ERROR_WANT_READ);
  std::string out(BIO_ctrl_pending(SSL_get_wbio(ssl_)), '\0');
  if (!out.empty()) BIO_read(SSL_get_wbio(ssl_), out.data(), static_cast<int>(out.size()));
  return out;
}

void RawTls::feed(std::string_view bytes) {
  BIO_write(SSL_get_rbio(ssl_), bytes.data(), static_cast<int>(bytes.size()));
}

void RawTls::shakeHands(asio::io_context& context, tcp::socket& socket) {
  std::error_code error;
  socket.non_blocking(true);
  EXPECT_TRUE(runUntil(context, [&] {
    const std::string out = advance();
    if (!out.empty()) asio::write(socket, asio::buffer(out), error);
    std::array<char, 4096> in;
    const std::size_t size = socket.read_some(asio::buffer(in), error);
    feed({in.data(), size});
    const bool over = error && error != asio::error::would_block;
    if (over && !done()) failed_ = true;
    return done() || failed_;
  }));
}

void offerAlpn(SSL_CTX* context, std::string_view name) {
  const std::string list = name.empty() ? "" : static_cast<char>(name.size()) + std::string(name);
  SSL_CTX_set_alpn_protos(context, reinterpret_cast<const unsigned char*>(list.data()),
                          static_cast<unsigned int>(list.size()));
}

}  // namespace naiad::test
