#include "RawClient.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad::test {

namespace {

constexpr int kPatienceMillis = 30'000;

/// Returns a context that accepts any server certificate.
SSL_CTX* anyServer() {
  static const auto context = TlsContext::forClient();
  return context->get();
}

}  // namespace

void RawClient::FreeTls::operator()(ssl_st* tls) const {
  SSL_free(tls);
}

RawClient::RawClient(std::uint16_t port, Line line) {
  m_socket.connect({asio::ip::address_v4::loopback(), port});
  m_socket.non_blocking(true);
  if (line == Line::kPlain) return;
  m_bio.socket = m_socket.native_handle();
  m_tls.reset(SSL_new(anyServer()));
  bio_st* const p_bio = m_bio.make();
  SSL_set_bio(m_tls.get(), p_bio, p_bio);
  SSL_set_connect_state(m_tls.get());
  transfer(true, nullptr, 0);
}

// Waits until bytes can be sent (if `out`) or read. False after kPatienceMillis.
bool RawClient::await(bool out) {
  pollfd watched{m_socket.native_handle(), static_cast<short>(out ? POLLOUT : POLLIN), 0};
  m_timed_out = poll(&watched, 1, kPatienceMillis) <= 0;
  return !m_timed_out;
}

// Sends (if `out`) or reads bytes. Returns their number; 0 or less if the connection has ended. With a count
// of 0 it does the TLS handshake.
int RawClient::transfer(bool out, char* bytes, std::size_t count) {
  const int size = static_cast<int>(count);
  while (m_socket.is_open()) {
    bool wants_out = out;
    int done = 0;
    if (m_tls != nullptr) {
      ERR_clear_error();
      done = size == 0 ? SSL_do_handshake(m_tls.get())
             : out     ? SSL_write(m_tls.get(), bytes, size)
                       : SSL_read(m_tls.get(), bytes, size);
      const int error = SSL_get_error(m_tls.get(), done);
      if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) return done;
      wants_out = error == SSL_ERROR_WANT_WRITE;
    } else {
      const int fd = m_socket.native_handle();
      done = static_cast<int>(out ? ::send(fd, bytes, count, MSG_NOSIGNAL) : ::recv(fd, bytes, count, 0));
      if (done >= 0 || (errno != EAGAIN && errno != EWOULDBLOCK)) return done;
    }
    if (!await(wants_out)) return -1;
  }
  return -1;
}

void RawClient::sendBytes(const std::string& bytes) {
  std::string rest = bytes;
  while (!rest.empty()) {
    const int sent = transfer(true, rest.data(), rest.size());
    if (sent <= 0) return;
    rest.erase(0, static_cast<std::size_t>(sent));
  }
}

void RawClient::sendFrame(const std::string& payload) {
  std::string bytes;
  appendFrame(bytes, payload);
  sendBytes(bytes);
}

std::optional<std::string> RawClient::readExactly(std::size_t count) {
  std::string bytes(count, '\0');
  for (std::size_t have = 0; have < count;) {
    const int got = transfer(false, bytes.data() + have, count - have);
    if (got <= 0) return std::nullopt;
    have += static_cast<std::size_t>(got);
  }
  return bytes;
}

std::optional<wire::ServerMessage> RawClient::receive() {
  const auto header = readExactly(2);
  if (!header) return std::nullopt;
  const auto low = static_cast<unsigned char>((*header)[0]);
  const auto high = static_cast<unsigned char>((*header)[1]);
  const auto payload = readExactly(low + 256u * high);
  wire::ServerMessage message;
  if (!payload || !message.ParseFromString(*payload)) return std::nullopt;
  return message;
}

bool RawClient::waitForHangup() {
  while (receive()) {
  }
  return !m_timed_out;
}

bool RawClient::finish() {
  asio::error_code ignored;
  if (m_tls != nullptr) SSL_shutdown(m_tls.get());
  m_socket.shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
  return waitForHangup();
}

void RawClient::reset() {
  m_socket.set_option(asio::socket_base::linger(true, 0));
  m_socket.close();
}

}  // namespace naiad::test
