#include "server/gateway/SecureSocket.h"

#include <linux/sockios.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <boost/asio/error.hpp>

#include "shared/net/stream/SocketBio.h"

namespace naiad {

namespace net = boost::asio;

namespace {

constexpr std::size_t kMaxIdle = 1024;    // maximum capacity in bytes of an empty output buffer
constexpr std::size_t kRecordExtra = 64;  // maximum bytes that TLS adds to a record

}  // namespace

/// Allocated separately, because OpenSSL points to it and the socket may be moved.
struct SecureSocket::Tls {
  struct Free {
    void operator()(SSL* freed) const { SSL_free(freed); }
  };
  SocketBio bio;
  std::unique_ptr<SSL, Free> ssl;
};

SecureSocket::SecureSocket(Socket socket) : m_socket(std::move(socket)) {
  error_code ignored;  // a closed socket fails at the next operation
  m_socket.non_blocking(true, ignored);
}

SecureSocket::~SecureSocket() = default;
SecureSocket::SecureSocket(SecureSocket&&) noexcept = default;
SecureSocket& SecureSocket::operator=(SecureSocket&&) noexcept = default;

bool SecureSocket::startTls(ssl_ctx_st* context, Role role) {
  auto tls = std::make_unique<Tls>();
  tls->ssl.reset(SSL_new(context));
  tls->bio.socket = m_socket.native_handle();
  BIO* const bio = tls->ssl ? tls->bio.make() : nullptr;
  if (!bio) return false;
  SSL_set_bio(tls->ssl.get(), bio, bio);  // the SSL owns the BIO now
  SSL_set_read_ahead(tls->ssl.get(), 1);  // reads the header and the rest of a record with one system call
  if (role == Role::kServer) {
    tls->bio.guard.emplace();
    SSL_set_accept_state(tls->ssl.get());
  } else {
    SSL_set_connect_state(tls->ssl.get());
  }
  m_tls = std::move(tls);
  m_is_server = role == Role::kServer;
  return true;
}

std::optional<Fingerprint> SecureSocket::provenKey(std::string_view protocol) const {
  if (!m_tls) return std::nullopt;
  const unsigned char* data = nullptr;
  unsigned int size = 0;
  SSL_get0_alpn_selected(m_tls->ssl.get(), &data, &size);
  const X509* const certificate = SSL_get0_peer_certificate(m_tls->ssl.get());
  if (!certificate || std::string_view(reinterpret_cast<const char*>(data), size) != protocol)
    return std::nullopt;
  return Fingerprint::of(*certificate);
}

bool SecureSocket::hasEnded() const {
  return m_tls && (m_tls->bio.ended || m_tls->bio.failed);
}

bool SecureSocket::hasUnsent(std::size_t limit) {
  if (m_unsent_bound <= limit) return false;
  int bytes = 0;
  if (ioctl(m_socket.native_handle(), SIOCOUTQNSD, &bytes) != 0 || bytes < 0) return false;
  m_unsent_bound = static_cast<std::size_t>(bytes);
  return m_unsent_bound > limit;
}

bool SecureSocket::flush() {
  return m_is_mid_write || !tryFlush().error;
}

SecureSocket::Progress SecureSocket::tryFlush() {
  while (queuedBytes() > 0) {
    const std::span<const char> left(m_queued.data() + m_queued_begin, std::min(queuedBytes(), kFlatSize));
    const Progress progress =
        m_tls ? tryWriteTls(left) : toProgress(writePlain(net::const_buffer(left.data(), left.size())));
    if (progress.outcome != Outcome::kDone || progress.error) return progress;
    m_queued_begin += progress.bytes;
  }
  m_queued_begin = 0;
  m_queued.clear();
  if (m_queued.capacity() > kMaxIdle) std::string().swap(m_queued);
  return {};
}

void SecureSocket::shutDownSend() {
  if (m_tls && SSL_is_init_finished(m_tls->ssl.get())) {
    ERR_clear_error();
    SSL_shutdown(m_tls->ssl.get());
    ERR_clear_error();
  }
  error_code ignored;
  m_socket.shutdown(Socket::shutdown_send, ignored);
}

void SecureSocket::close() {
  error_code ignored;
  m_socket.close(ignored);
}

/// A buffer for all connections of the thread. One is enough, because its contents are encrypted at once.
std::span<char> SecureSocket::flatBytes() {
  static thread_local std::array<char, kFlatSize> bytes;
  return bytes;
}

bool SecureSocket::holdsInput() const {
  return m_tls &&
         SSL_has_pending(m_tls->ssl.get()) == 1;  // also true for a partial record: one read is then in vain
}

SecureSocket::Progress SecureSocket::toProgress(std::pair<error_code, std::size_t> written) {
  const bool again = written.first == net::error::would_block || written.first == net::error::interrupted;
  return again ? Progress{Outcome::kWantsWrite} : Progress{Outcome::kDone, written.second, written.first};
}

SecureSocket::Progress SecureSocket::tryHandshake() {
  ERR_clear_error();
  const int result = SSL_do_handshake(m_tls->ssl.get());
  if (result == 1) m_tls->bio.guard.reset();
  return toTlsProgress(result, 0);
}

SecureSocket::Progress SecureSocket::tryRead(std::span<char> into) {
  if (!m_socket.is_open()) return {Outcome::kDone, 0, net::error::operation_aborted};
  if (m_tls) {
    ERR_clear_error();
    std::size_t size = 0;
    const int result = SSL_read_ex(m_tls->ssl.get(), into.data(), into.size(), &size);
    return toTlsProgress(result, size);
  }
  error_code error;
  const std::size_t size = m_socket.read_some(net::buffer(into.data(), into.size()), error);
  const bool again = error == net::error::would_block || error == net::error::interrupted;
  return again ? Progress{Outcome::kWantsRead} : Progress{Outcome::kDone, size, error};
}

SecureSocket::Progress SecureSocket::tryWriteTls(std::span<const char> bytes) {
  if (!m_socket.is_open()) return {Outcome::kDone, 0, net::error::operation_aborted};
  ERR_clear_error();
  std::size_t size = 0;
  const int result = SSL_write_ex(m_tls->ssl.get(), bytes.data(), bytes.size(), &size);
  m_unsent_bound += bytes.size() + kRecordExtra;
  return toTlsProgress(result, size);
}

/// Reads and discards raw bytes, below TLS.
SecureSocket::Progress SecureSocket::tryDrain(std::size_t& drained) {
  std::array<char, 4096> bytes;
  error_code error;
  drained += m_socket.read_some(net::buffer(bytes), error);
  const bool again = !error || error == net::error::would_block || error == net::error::interrupted;
  if (again && drained < kMaxDrained) return {Outcome::kWantsRead};
  return {Outcome::kDone, 0, error == net::error::eof ? error_code() : error};
}

SecureSocket::Progress SecureSocket::toTlsProgress(int result, std::size_t bytes) {
  if (result == 1) return {Outcome::kDone, bytes};
  const int reason = SSL_get_error(m_tls->ssl.get(), result);
  ERR_clear_error();
  switch (reason) {
    case SSL_ERROR_WANT_READ:
      return {Outcome::kWantsRead};
    case SSL_ERROR_WANT_WRITE:
      return {Outcome::kWantsWrite};
    case SSL_ERROR_ZERO_RETURN:
      return {Outcome::kDone, 0, net::error::eof};
    default:
      return {Outcome::kDone, 0, net::error::connection_reset};
  }
}

void beast_close_socket(SecureSocket& socket) {
  socket.close();
}

void teardown(boost::beast::role_type, SecureSocket& socket, error_code& error) {
  error = {};
  socket.shutDownSend();
}

}  // namespace naiad
