// A client whose player plays at random, over a bad network in virtual time. Joins and reconnects like
// client/session/Connection does for dfclient.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "Tally.h"
#include "VirtualHost.h"
#include "Weather.h"
#include "client/bot/BotScript.h"
#include "client/session/ClientSession.h"
#include "tests/loopback/BusyWorld.h"
#include "tests/support/net/LossyLink.h"

namespace naiad::soak {

using test::Heard;

class Bot {
 public:
  struct Place {
    VirtualClock& clock;
    VirtualNetwork& network;
    VirtualHost& host;
    Endpoint server;
    Tally& tally;
  };
  /// Called after each snapshot of the shown session.
  using OnSnapshot = std::function<void(Bot& bot, const SnapshotHeader& header, const AckWindow& acks)>;

  Bot(Place place, int number, std::uint64_t seed, double haste, OnSnapshot on_snapshot);

  /// Applies random network events, presses keys, and counts the client as stuck if it receives nothing. Call
  /// once a tick.
  void tick();
  /// Checks timeouts. Call a few times a tick.
  void update();
  /// Call when the game received an input of this player.
  void heard(const Heard& what);
  /// Makes the network perfect and stops pressing keys, for the rest of the run.
  void rest();

  /// Returns the shown session; null if it is missing.
  ClientSession* session() { return m_shown.session.get(); }
  /// Returns the player of the shown session; 0 without one.
  std::uint32_t player() const;
  /// Returns how many sent keys and clicks the game has not received.
  std::size_t unheard() const { return m_unheard.size(); }
  const Weather& weather() const { return m_weather; }
  std::string describe() const;

 private:
  using Time = ClientSession::Time;
  /// A session with its stream and datagram socket.
  struct Seat {
    std::unique_ptr<ClientSession> session;
    std::unique_ptr<VirtualStreamLink> link;
    const DatagramSocket* p_socket = nullptr;
  };

  Time now() const { return timeOf(m_place.clock); }
  void forgetInputs();
  void attempt();
  void attach();
  std::unique_ptr<ClientSession> makeSession(std::unique_ptr<ReliableChannel> channel, Seat& seat);
  void checkPending();
  void checkShown();
  void tryAgain();
  void applyWeather();
  void applyTo(const Seat& seat) const;
  void strike(const Strokes& strokes);
  void quit(std::chrono::milliseconds pause);
  void press();
  void watch();

  Place m_place;
  int m_number;
  SplitMix64 m_random;
  OnSnapshot m_on_snapshot;
  Weather m_weather;
  RandomPlayer m_player;
  bool m_resting = false;
  Seat m_shown;
  Seat m_pending;
  std::shared_ptr<const DatagramSocket*> m_p_opened;
  std::chrono::milliseconds m_backoff{250};
  Time m_next_attempt{};
  bool m_connecting = false;
  std::deque<Heard> m_unheard;
  std::set<int> m_down;    ///< keys that are down in the game
  std::set<int> m_let_go;  ///< keys released in the game, maybe by the server before the player's release
  Time m_calm_since{};
  Time m_news_at{};
  std::uint64_t m_snapshots_seen = 0;
};

}  // namespace naiad::soak
