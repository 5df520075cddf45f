// Does for its sessions what Host does (greet, admit, resume, tick), in virtual time and without a listener.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/world/World.h"
#include "host/auth/ResumeTokens.h"
#include "host/net/DatagramService.h"
#include "host/session/Counters.h"
#include "host/session/Session.h"
#include "host/snapshot/Publisher.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/net/VirtualClock.h"
#include "tests/support/net/VirtualNetwork.h"

namespace naiad::soak {

/// Converts the time of the virtual clock to a time for sessions.
inline Session::Clock::time_point timeOf(const VirtualClock& clock) {
  return Session::Clock::time_point(std::chrono::hours(1)) + clock.now();
}

class VirtualHost {
 public:
  VirtualHost(df::World& world, const VirtualClock& clock, VirtualNetwork& network, const Endpoint& address,
              std::uint64_t seed);

  /// Accepts a client's connection.
  void accept(std::unique_ptr<ReliableChannel> channel);
  /// Runs a tick: inputs, world, snapshots. Calls `on_ticked` after the world's tick, before the snapshots.
  void tick(const std::function<void()>& on_ticked);

  const Counters& counters() const { return m_counters; }
  /// Returns the socket that carries all datagrams of the server.
  const DatagramSocket& socket() const { return *m_p_socket; }
  /// Returns the session of a player; null if it has ended.
  Session* find(std::uint32_t player) const;
  /// Returns the number of players, including disconnected ones in their grace time.
  std::size_t playing() const;

 private:
  void greet(Session& session, const wire::Hello& hello);
  bool resume(Session& session, const wire::Hello& hello);
  void admit(Session& session, const wire::Hello& hello);
  void chat(const Session& session, const std::string& text);
  void applyInputs();
  void sendSnapshots();
  void sendPlayers();
  template <class Visit>
  void forEachPlaying(Visit visit) const;

  df::World& m_world;
  const VirtualClock& m_clock;
  SplitMix64 m_random;
  Counters m_counters;
  const DatagramSocket* m_p_socket = nullptr;
  std::unique_ptr<DatagramService> m_datagrams;
  ResumeTokens m_tokens;
  std::uint64_t m_next_session = 1;
  std::vector<std::unique_ptr<Session>> m_sessions;
  Publisher m_publisher;
  std::string m_players_told;
};

}  // namespace naiad::soak
