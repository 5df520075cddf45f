#include "RecordingServer.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>

#include <array>
#include <memory>

#include "shared/net/stream/SocketBio.h"

namespace naiad::test {

RecordingServer::RecordingServer(const std::filesystem::path& identity)
    : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
      m_acceptor(m_context, {asio::ip::address_v4::loopback(), 0}),
      m_port(m_acceptor.local_endpoint().port()),
      m_thread([this] { run(); }) {}

RecordingServer::~RecordingServer() {
  m_stopping = true;
  m_thread.join();
}

std::string RecordingServer::heard() const {
  const std::lock_guard lock(m_mutex);
  return m_heard;
}

// Waits until the socket is ready. False if the server stops.
bool RecordingServer::await(int socket, bool out) const {
  pollfd watched{socket, static_cast<short>(out ? POLLOUT : POLLIN), 0};
  while (!m_stopping) {
    if (poll(&watched, 1, 20) > 0) return true;
  }
  return false;
}

void RecordingServer::run() {
  while (await(m_acceptor.native_handle(), false)) {
    asio::ip::tcp::socket socket(m_context);
    asio::error_code failed;
    m_acceptor.accept(socket, failed);
    if (failed) continue;
    socket.non_blocking(true);
    serve(socket.native_handle());
  }
}

void RecordingServer::serve(int socket) {
  SocketBio line;
  line.socket = socket;
  const std::unique_ptr<SSL, void (*)(SSL*)> tls(SSL_new(m_identity.tls()->get()), SSL_free);
  bio_st* const p_bio = line.make();
  SSL_set_bio(tls.get(), p_bio, p_bio);
  SSL_set_accept_state(tls.get());
  std::array<char, 4096> bytes{};
  while (true) {
    ERR_clear_error();
    const int count = SSL_read(tls.get(), bytes.data(), static_cast<int>(bytes.size()));
    if (count > 0) {
      const std::lock_guard lock(m_mutex);
      m_heard.append(bytes.data(), static_cast<std::size_t>(count));
      continue;
    }
    const int error = SSL_get_error(tls.get(), count);
    if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) break;
    if (!await(socket, error == SSL_ERROR_WANT_WRITE)) return;
  }
  if (SSL_is_init_finished(tls.get()) != 0) ++m_finished;
}

}  // namespace naiad::test
