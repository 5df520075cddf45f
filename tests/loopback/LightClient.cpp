#include "LightClient.h"

#include <algorithm>
#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"

namespace naiad::test {

using asio::ip::tcp;
using namespace std::chrono_literals;

namespace {

/// Created once because it reads all of the machine's certificates.
const std::shared_ptr<const TlsContext>& clientTls() {
  static const std::shared_ptr<const TlsContext> made = TlsContext::forClient();
  return made;
}

}  // namespace

LightClient::LightClient(asio::io_context& context, std::uint16_t server, const std::string& address)
    : m_context(context),
      m_server(asio::ip::address_v4::loopback(), server),
      m_own(asio::ip::make_address(address), 0),
      m_timer(context) {}

LightClient::~LightClient() {
  m_on_judged = nullptr;
  drop();
}

void LightClient::join() {
  drop();
  m_state = State::kJoining;
  const auto socket = std::make_shared<tcp::socket>(m_context, m_own);
  m_socket = socket;
  socket->async_connect(m_server, [this, socket](const std::error_code& error) {
    if (m_socket != socket) return;  // drop() was called
    m_socket.reset();
    if (error) return end(State::kHungUp);
    m_handshake = std::make_shared<TlsHandshake>(
        std::make_unique<TlsStream>(std::move(*socket), clientTls(), "127.0.0.1"));
    m_handshake->run(30s, [this](TlsHandshake::End result, std::unique_ptr<TlsStream> stream, const auto&) {
      m_handshake.reset();
      if (!stream || result != TlsHandshake::End::kDone) return end(State::kHungUp);
      m_channel = makeTcpChannel(std::move(stream), TcpOptions{.receive_limit = kMaxServerFrame});
      m_channel->start({[this](std::string_view frame) { onFrame(frame); },
                        [this](CloseReason) {
                          if (m_state == State::kJoining) end(State::kHungUp);
                        }});
      wire::ClientMessage message;
      wire::Hello& hello = *message.mutable_hello();
      hello.set_magic(kHelloMagic);
      hello.set_protocol(kProtocolVersion);
      hello.set_player_name("light");
      hello.set_resume_token(m_welcome.resume_token());
      m_channel->send(message.SerializeAsString());
    });
  });
}

void LightClient::joinAfter(std::chrono::milliseconds pause) {
  m_timer.expires_after(pause);
  m_timer.async_wait([this](const std::error_code& error) {
    if (!error) join();
  });
}

void LightClient::joinUntilWelcome() {
  m_insists = true;
  m_backoff = 250ms;
  join();
}

void LightClient::drop() {
  m_timer.cancel();
  m_socket.reset();
  if (m_handshake) m_handshake->cancel();
  m_handshake.reset();
  m_channel.reset();
  m_state = State::kIdle;
}

void LightClient::onFrame(std::string_view frame) {
  wire::ServerMessage message;
  if (m_state != State::kJoining || !message.ParseFromArray(frame.data(), static_cast<int>(frame.size())))
    return;
  if (message.has_welcome()) {
    m_welcome = message.welcome();
    m_insists = false;
    end(State::kWelcome);
  } else if (message.has_refused()) {
    end(State::kRefused);
  }
}

void LightClient::end(State state) {
  m_state = state;
  if (m_insists) joinAfter(std::exchange(m_backoff, std::min<std::chrono::milliseconds>(m_backoff * 2, 2s)));
  if (m_on_judged) m_on_judged(*this);
}

}  // namespace naiad::test
