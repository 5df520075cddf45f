#include "server/gateway/UpstreamLink.h"

#include <algorithm>
#include <boost/asio/error.hpp>
#include <utility>

namespace naiad {
namespace {

/// First and longest pause between attempts; the pause doubles after each attempt.
constexpr std::chrono::milliseconds kFirstRetryDelay{50};
constexpr std::chrono::milliseconds kLastRetryDelay{800};
/// Time for retries, as in dfclient: if too many clients connect at once, the server drops some of them.
constexpr std::chrono::seconds kRetryTimeout{4};

}  // namespace

UpstreamLink::UpstreamLink(GatewayExecutor executor, const GameServer& server)
    : m_server(server), m_socket(executor), m_retry(executor) {}

void UpstreamLink::open(std::string header, Done done) {
  m_header = std::move(header);
  m_done = std::move(done);
  m_retry_delay = kFirstRetryDelay;
  m_retry_until = std::chrono::steady_clock::now() + kRetryTimeout;
  connect();
}

bool UpstreamLink::connectAgain() {
  if (std::chrono::steady_clock::now() >= m_retry_until) return false;
  error_code ignored;
  m_socket.close(ignored);
  if (m_stream) m_stream->close();
  m_retry.expires_after(m_retry_delay);
  m_retry_delay = std::min(2 * m_retry_delay, kLastRetryDelay);
  m_retry.async_wait([self = shared_from_this()](error_code) {
    if (self->m_done) self->connect();
  });
  return true;
}

void UpstreamLink::connect() {
  m_socket.async_connect(Local::endpoint(m_server.socket), [self = shared_from_this()](error_code error) {
    if (self->m_done) self->onConnected(error);
  });
}

void UpstreamLink::onConnected(error_code error) {
  // The header fits into the socket's empty buffer as a whole.
  if (!error) m_socket.write_some(boost::asio::buffer(m_header), error);
  // Temporary errors: the server's backlog is full, or the server closed the connection at once.
  const bool dropped =
      error == boost::asio::error::broken_pipe || error == boost::asio::error::connection_reset;
  if ((dropped || error == boost::asio::error::try_again) && connectAgain()) return;
  if (error) return finish(dropped ? End::kDropped : End::kUnreachable, error.message());
  m_stream.emplace(std::move(m_socket));
  if (!m_stream->startTls(m_server.tls->get(), SecureSocket::Role::kClient))
    return finish(End::kUnreachable, "out of memory for TLS");
  m_stream->asyncHandshake([self = shared_from_this()](error_code failed) {
    if (self->m_done) self->onHandshake(failed);
  });
}

void UpstreamLink::onHandshake(error_code error) {
  if (error && m_stream->hasEnded() && connectAgain()) return;
  if (error && m_stream->hasEnded())
    return finish(End::kDropped, "the address may be banned, or it is not a Naiad server");
  if (error) return finish(End::kUnreachable, "the TLS handshake failed, or it is not a Naiad server");
  const auto key = m_stream->provenKey(kAlpn);
  if (!key) return finish(End::kUnreachable, "it does not speak " + std::string(kAlpn));
  if (ShortKey::of(*key) != m_server.key)
    return finish(End::kWrongKey, "the server's key is " + ShortKey::of(*key).text());
  finish(End::kOpen, "");
}

void UpstreamLink::finish(End end, const std::string& problem) {
  m_is_open = end == End::kOpen;
  const Done call = std::exchange(m_done, nullptr);
  if (!m_is_open) close();
  call(end, problem);
}

void UpstreamLink::close() {
  m_done = nullptr;
  m_retry.cancel();
  error_code ignored;
  m_socket.close(ignored);
  if (!m_stream) return;
  if (std::exchange(m_is_open, false)) {
    m_stream->flush();  // the browser's last messages, if the server accepts them without waiting
    m_stream->shutDownSend();
  }
  m_stream->close();
}

}  // namespace naiad
