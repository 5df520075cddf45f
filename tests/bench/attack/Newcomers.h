// New players, one a second, each from an address of its own, who join and leave: how long do they wait?
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "Guest.h"
#include "HonestPlayer.h"

namespace bench::attack {

class Newcomers {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// After so long one gives up.
  static constexpr std::chrono::milliseconds kPatience{5000};

  Newcomers(asio::io_context& context, const Whereabouts& server) : m_context(context), m_server(server) {}

  /// Another one comes each second, from now on.
  void begin(Time now) { m_next = now; }
  /// No more come.
  void end() { m_next = Time::max(); }
  void update(Time now);
  /// Some still try to join, or leave.
  bool isBusy() const { return !m_guests.empty(); }

  int count() const { return m_count; }
  /// Those that were refused, hung up on, or gave up.
  int failed() const { return m_failed; }
  /// From the first byte to the picture; kPatience for those that failed.
  double slowestMillis() const { return m_slowest_ms; }

 private:
  struct Newcomer {
    std::string address;
    Time since;
    Time next_attempt;  ///< if there is no guest
    bool joined = false;
    Time joined_at{};
    std::unique_ptr<Guest> guest;
  };
  bool serve(Newcomer& newcomer, Time now);

  asio::io_context& m_context;
  const Whereabouts& m_server;
  Time m_next = Time::max();
  std::vector<Newcomer> m_guests;
  int m_count = 0;
  int m_failed = 0;
  double m_slowest_ms = 0;
};

}  // namespace bench::attack
