#include "Checker.h"

#include <algorithm>
#include <memory>

#include "../Check.h"
#include "LightBot.h"
#include "shared/net/datagram/UdpSocket.h"

namespace bench::capacity {

using namespace naiad;

namespace {

SessionOptions optionsOf(asio::io_context& context, const std::string& address, int index) {
  SessionOptions options;
  options.name = kCheckedName + std::to_string(index);
  options.program = "naiad_capacity_bots";
  options.open_socket = [&context, address](const Endpoint&) -> std::unique_ptr<DatagramSocket> {
    UdpOptions udp;
    udp.address = address;
    return std::make_unique<UdpSocket>(context, udp);
  };
  return options;
}

}  // namespace

Checker::Checker(asio::io_context& context, const ServerAddress& server, const Fingerprint& fingerprint,
                 const std::string& address, int index, const std::string& known_servers)
    : m_connection(context, server, optionsOf(context, address, index), false,
                   ServerTrust{.fingerprint = fingerprint, .known_servers = known_servers}),
      m_random(static_cast<std::uint64_t>(index)) {
  m_connection.onSession([this](ClientSession& session) {
    session.onBeforeSnapshot([this, &session](std::uint32_t tick) { record(session, tick); });
  });
  m_connection.start();
}

// Before a snapshot of a new tick is applied, all ticks since the last one are final.
void Checker::record(ClientSession& session, std::uint32_t tick) {
  const std::uint32_t known = session.clock().newestTick();
  if (known == 0 || tick == known) return;
  for (std::uint32_t t = std::max(m_recorded + 1, known); t < tick; ++t) {
    if (isChecked(session.welcome().player, t)) {
      m_pictures.push_back({t, pictureSum(session.replica().render(t))});
    }
  }
  m_recorded = tick - 1;
}

void Checker::update(Time now) {
  m_connection.update(now);
  ClientSession* session = m_connection.session();
  if (session == nullptr || m_connection.isOver() || now < m_next_key) return;
  m_next_key = now + LightBot::kInputEvery;
  if (m_random.below(LightBot::kTurnsOneIn) == 0) m_left = !m_left;
  session->sendKey(m_left ? df::Keyboard::LEFTARROW : df::Keyboard::RIGHTARROW, df::KEY_PRESSED, now);
}

bool Checker::isReady(Time now) {
  ClientSession* session = m_connection.session();
  return session != nullptr && session->hasPicture(now) && session->hasDatagrams(now);
}

}  // namespace bench::capacity
