// A player with a complete session like dfclient's, whose screen is compared with the server's.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../Check.h"
#include "LightBot.h"
#include "client/session/Connection.h"
#include "shared/net/datagram/UdpSocket.h"
#include "shared/values/SplitMix64.h"

namespace bench::capacity {

/// Not thread-safe.
class Checker {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Picture {
    std::uint32_t tick;
    std::uint64_t sum;
  };

  /// Joins from `address`, a numeric address.
  Checker(asio::io_context& context, const naiad::ServerAddress& server,
          const naiad::Fingerprint& fingerprint, const std::string& address, int index,
          const std::string& known_servers)
      : m_connection(context, server, optionsOf(context, address, index), false,
                     trustIn(fingerprint, known_servers)),
        m_random(static_cast<std::uint64_t>(index)) {
    m_connection.onSession([this](naiad::ClientSession& session) {
      session.onBeforeSnapshot([this, &session](std::uint32_t tick) { record(session, tick); });
    });
    m_connection.start();
  }

  void update(Time now) {
    m_connection.update(now);
    naiad::ClientSession* session = m_connection.session();
    if (session == nullptr || m_connection.isOver() || now < m_next_key) return;
    m_next_key = now + LightBot::kInputEvery;
    if (m_random.below(LightBot::kTurnsOneIn) == 0) m_left = !m_left;
    session->sendKey(m_left ? df::Keyboard::LEFTARROW : df::Keyboard::RIGHTARROW, df::KEY_PRESSED, now);
  }
  bool isReady(Time now) {
    naiad::ClientSession* session = m_connection.session();
    return session != nullptr && session->hasPicture(now) && session->hasDatagrams(now);
  }
  bool isOver() const { return m_connection.isOver(); }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  /// Returns the pictures of checked ticks (Check.h), recorded when they could no longer change.
  const std::vector<Picture>& pictures() const { return m_pictures; }
  void forget() { m_pictures.clear(); }

 private:
  static naiad::ServerTrust trustIn(const naiad::Fingerprint& fingerprint, const std::string& known_servers) {
    naiad::ServerTrust trust;
    trust.fingerprint = fingerprint;
    trust.known_servers = known_servers;
    return trust;
  }
  static naiad::SessionOptions optionsOf(asio::io_context& context, const std::string& address, int index) {
    naiad::SessionOptions options;
    options.name = kCheckedName + std::to_string(index);
    options.program = "naiad_capacity_bots";
    options.open_socket = [&context,
                           address](const naiad::Endpoint&) -> std::unique_ptr<naiad::DatagramSocket> {
      naiad::UdpOptions udp;
      udp.address = address;
      return std::make_unique<naiad::UdpSocket>(context, udp);
    };
    return options;
  }

  // Before a snapshot of a new tick is applied, all ticks since the last one are final.
  void record(naiad::ClientSession& session, std::uint32_t tick) {
    const std::uint32_t known = session.clock().newestTick();
    if (known == 0 || tick == known) return;
    for (std::uint32_t t = std::max(m_recorded + 1, known); t < tick; ++t) {
      if (isChecked(session.welcome().player, t)) {
        m_pictures.push_back({t, pictureSum(session.replica().render(t))});
      }
    }
    m_recorded = tick - 1;
  }

  naiad::Connection m_connection;
  std::vector<Picture> m_pictures;
  std::uint32_t m_recorded = 0;  ///< newest tick whose picture was considered
  Time m_next_key{};
  naiad::SplitMix64 m_random;
  bool m_left = false;
};

}  // namespace bench::capacity
