#include "Guest.h"

#include <utility>

#include "shared/net/base/Limits.h"

namespace bench::attack {
namespace {

constexpr std::chrono::seconds kPatience{5};

naiad::TcpOptions clientChannel() {
  naiad::TcpOptions options;
  options.receive_limit = naiad::kMaxServerFrame;
  return options;
}

}  // namespace

// Each thread has its own context, because a context must not be shared by threads.
std::shared_ptr<const naiad::TlsContext> clientTls() {
  thread_local const std::shared_ptr<const naiad::TlsContext> s_context = naiad::TlsContext::forClient();
  return s_context;
}

naiad::SessionOptions guestOptions(const std::string& name, const std::string& password) {
  naiad::SessionOptions options;
  options.name = name;
  options.program = "naiad_attack";
  options.password = password;
  return options;
}

std::string longLine() {
  std::string line;
  for (std::size_t i = 0; i < naiad::kMaxChatLength; ++i) line += "\u2588";
  return line;
}

std::string addressIn(int network, int n) {
  return "127." + std::to_string(network) + "." + std::to_string(n / 250) + "." + std::to_string(1 + n % 250);
}

Guest::Guest(asio::io_context& context, std::uint16_t server_port, const std::string& source,
             const naiad::SessionOptions& options)
    : m_relay(context, server_port, {.source = source}), m_connector(context, clientChannel(), clientTls()) {
  m_connector.connect("127.0.0.1", m_relay.port(), kPatience,
                      [this, options](std::unique_ptr<naiad::ReliableChannel> channel, const std::string&) {
                        if (channel) return attach(std::move(channel), options);
                        m_state = State::kLost;
                      });
}

void Guest::attach(std::unique_ptr<naiad::ReliableChannel> channel, const naiad::SessionOptions& options) {
  naiad::ReliableChannel& started = *channel;
  const auto clock = &std::chrono::steady_clock::now;
  m_session = std::make_unique<naiad::ClientSession>(std::move(channel), options, clock());
  started.start({[this, clock](std::string_view frame) { m_session->receive(frame, clock()); },
                 [this](naiad::CloseReason reason) { m_session->closed(reason); }});
}

void Guest::update(Time now) {
  if (!m_session || isOver()) return;
  m_session->update(now);
  switch (m_session->state()) {
    case naiad::ClientSession::State::kGreeting:
      return;
    case naiad::ClientSession::State::kPlaying:
      m_state = m_session->isDetached() ? State::kLost : State::kPlaying;
      return;
    case naiad::ClientSession::State::kRefused:
      m_state = m_session->refusal().is_temporary ? State::kRefusedForNow : State::kRefused;
      return;
    default:
      m_state = State::kLost;
  }
}

}  // namespace bench::attack
