// A player who sees everything: the session that dfclient has, whose screen is compared with the server's.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "client/session/Connection.h"
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

  /// Joins. `address`: its own, numeric.
  Checker(asio::io_context& context, const naiad::ServerAddress& server,
          const naiad::Fingerprint& fingerprint, const std::string& address, int index,
          const std::string& known_servers);

  void update(Time now);
  bool isReady(Time now);
  bool isOver() const { return m_connection.isOver(); }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  /// Of the ticks that are checked (Check.h), as they were when nothing could change them any more.
  const std::vector<Picture>& pictures() const { return m_pictures; }
  void forget() { m_pictures.clear(); }

 private:
  void record(naiad::ClientSession& session, std::uint32_t tick);

  naiad::Connection m_connection;
  std::vector<Picture> m_pictures;
  std::uint32_t m_recorded = 0;  ///< the newest tick that was looked at
  Time m_next_key{};
  naiad::SplitMix64 m_random;
  bool m_left = false;
};

}  // namespace bench::capacity
