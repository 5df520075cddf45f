// Each second, a new player joins from its own /24 and leaves. Measures how long these players wait.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Guest.h"
#include "HonestPlayer.h"

namespace bench::attack {

class Newcomers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time after which a newcomer gives up.
  static constexpr std::chrono::milliseconds kPatience{5000};

  Newcomers(asio::io_context& context, const Whereabouts& server) : m_context(context), m_server(server) {}

  /// Starts a newcomer each second from now on.
  void begin(Time now) { m_next = now; }
  /// Starts no more newcomers.
  void end() { m_next = Time::max(); }
  void update(Time now) {
    if (now >= m_next) {
      m_next = std::max(m_next + std::chrono::seconds(1), now);
      const std::string address = addressIn(kNetwork, kAddressesPerNetwork * m_count++);
      m_guests.push_back({.address = address, .since = now, .next_attempt = now, .guest = {}});
    }
    std::erase_if(m_guests, [&](Newcomer& newcomer) { return !serve(newcomer, now); });
  }
  /// True while newcomers try to join or leave.
  bool isBusy() const { return !m_guests.empty(); }

  int count() const { return m_count; }
  /// Returns the number of newcomers that were refused or disconnected, or gave up.
  int failed() const { return m_failed; }
  /// Returns the longest time from a newcomer's first byte to its picture; at least kPatience if one failed.
  double slowestMillis() const { return m_slowest_ms; }

 private:
  static constexpr int kNetwork = 90;
  static constexpr int kAddressesPerNetwork = 250;  // of addressIn()
  // Time after which a newcomer that the server asked to wait tries again, as long as dfclient's.
  static constexpr std::chrono::milliseconds kRetryDelay{250};
  static constexpr std::chrono::milliseconds kLeaveTime{500};  // time for the goodbye to arrive

  struct Newcomer {
    std::string address;
    Time since;
    Time next_attempt;  ///< valid while there is no guest
    bool joined = false;
    Time joined_at{};
    std::unique_ptr<Guest> guest;
  };
  // Returns false when the newcomer is finished.
  bool serve(Newcomer& newcomer, Time now) {
    const double waited = std::chrono::duration<double, std::milli>(now - newcomer.since).count();
    if (!newcomer.guest) {
      if (now < newcomer.next_attempt) return true;
      newcomer.guest =
          std::make_unique<Guest>(m_context, m_server.port, newcomer.address, "new", m_server.password);
    }
    Guest& guest = *newcomer.guest;
    guest.update(now);
    if (newcomer.joined) return !guest.isOver() && now - newcomer.joined_at < kLeaveTime;
    if (guest.hasPicture(now)) {
      m_slowest_ms = std::max(m_slowest_ms, waited);
      newcomer.joined = true;
      newcomer.joined_at = now;
      guest.session()->leave();
      return true;
    }
    const bool in_time = now - newcomer.since < kPatience;
    if (in_time && !guest.isOver()) return true;
    if (in_time && guest.state() == Guest::State::kRefusedForNow) {
      newcomer.guest.reset();
      newcomer.next_attempt = now + kRetryDelay;
      return true;
    }
    ++m_failed;
    m_slowest_ms =
        std::max(m_slowest_ms, std::max<double>(waited, std::chrono::milliseconds(kPatience).count()));
    return false;
  }

  asio::io_context& m_context;
  const Whereabouts& m_server;
  Time m_next = Time::max();
  std::vector<Newcomer> m_guests;
  int m_count = 0;
  int m_failed = 0;
  double m_slowest_ms = 0;
};

}  // namespace bench::attack
