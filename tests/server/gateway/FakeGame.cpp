#include "FakeGame.h"

#include <sys/socket.h>

#include <asio/post.hpp>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"

namespace naiad::test {

FakeGame::FakeGame(const std::filesystem::path& identity, const std::filesystem::path& socket,
                   OnFrame on_frame)
    : m_identity(ServerIdentity::loadOrMake(identity, std::chrono::system_clock::now())),
      m_on_frame(std::move(on_frame)) {
  if (!m_on_frame)
    m_on_frame = [](ReliableChannel& channel, const std::string& frame) { channel.send(frame); };
  ProxyListenerOptions listening;
  listening.path = socket;
  m_listener = std::make_unique<ProxyListener>(
      m_context, listening, [this](auto visitor, const auto& address) { meet(std::move(visitor), address); });
  m_thread = std::thread([this] { m_context.run(); });
}

FakeGame::~FakeGame() {
  onThread([this] {
    m_listener.reset();
    m_channels.clear();
    m_timer.cancel();
  });
  m_work.reset();
  m_context.stop();
  m_thread.join();
}

void FakeGame::meet(asio::generic::stream_protocol::socket socket, const asio::ip::tcp::endpoint& address) {
  {
    const std::lock_guard lock(m_mutex);
    m_visitors.push_back(peerName(address));
  }
  if (m_unwanted > 0) {
    --m_unwanted;
    return;
  }
  auto handshake =
      std::make_shared<TlsHandshake>(std::make_unique<TlsStream>(std::move(socket), m_identity.tls()));
  handshake->run(std::chrono::seconds(30),
                 [this](TlsHandshake::End, std::unique_ptr<TlsStream> stream, const std::string&) {
                   ++m_handshakes;
                   if (stream) serve(std::move(stream));
                 });
}

void FakeGame::serve(std::unique_ptr<TlsStream> stream) {
  const int id = ++m_newest;
  m_sockets[id] = stream->socket().native_handle();
  TcpOptions options;
  options.receive_limit = kMaxClientFrame;
  auto& channel = m_channels[id] = makeTcpChannel(std::move(stream), options);
  ReliableChannel::Callbacks callbacks;
  callbacks.on_frame = [this, id](std::string_view frame) {
    {
      const std::lock_guard lock(m_mutex);
      m_frames.emplace_back(frame);
    }
    m_on_frame(*m_channels.at(id), std::string(frame));
  };
  callbacks.on_closed = [this, id](CloseReason) {
    m_channels.erase(id);
    m_sockets.erase(id);
  };
  channel->start(std::move(callbacks));
}

std::vector<std::string> FakeGame::visitors() {
  const std::lock_guard lock(m_mutex);
  return m_visitors;
}

std::vector<std::string> FakeGame::frames() {
  const std::lock_guard lock(m_mutex);
  return m_frames;
}

void FakeGame::broadcast(const std::vector<std::string>& frames) {
  onThread([&] {
    for (const auto& [id, channel] : m_channels) {
      for (const std::string& frame : frames) channel->send(frame);
    }
  });
}

void FakeGame::endAll(bool in_order) {
  onThread([&] {
    for (const auto& [id, channel] : m_channels) {
      in_order ? channel->close() : static_cast<void>(::shutdown(m_sockets.at(id), SHUT_RDWR));
    }
  });
}

void FakeGame::every(std::chrono::milliseconds period, std::function<void(ReliableChannel&)> job) {
  onThread([&] {
    m_job = std::move(job);
    m_timer.expires_after(period);
    tick(period);
  });
}

void FakeGame::tick(std::chrono::milliseconds period) {
  m_timer.async_wait([this, period](const std::error_code& error) {
    if (error) return;
    for (const auto& [id, channel] : m_channels) m_job(*channel);
    m_timer.expires_at(m_timer.expiry() + period);
    tick(period);
  });
}

}  // namespace naiad::test
