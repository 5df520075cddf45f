// Hosts a game: the Runner behind GM.run() in dfserver.
//
// The thread that runs `run` owns worlds and sessions; the sockets have a thread of their own
// (NetworkThread.h). Between two ticks it hears what came on streams, at the deadline it runs the tick. `run`
// is the loop, `tick` one turn of it. Who plays in which world is the rooms' business (Room.h).
//
// Host.cpp has the loop, HostDoor.cpp how players come in, HostRounds.cpp what becomes of a world that ends.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/Runner.h"
#include "host/auth/PasswordCheck.h"
#include "host/auth/ResumeTokens.h"
#include "host/auth/ServerIdentity.h"
#include "host/net/NetworkThread.h"
#include "host/program/HostOptions.h"
#include "host/program/PlayerNews.h"
#include "host/program/Room.h"
#include "host/session/Counters.h"
#include "host/session/Session.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/replica/TruthFile.h"

namespace naiad {

class Host : public df::Runner {
 public:
  using Log = std::function<void(const std::string& line)>;

  /// Listens from now on (clients wait until run()). Throws ListenError, TlsError for keys that cannot be
  /// used, or std::runtime_error for a truth file that cannot be written.
  Host(HostOptions options, std::string game, Log log);
  ~Host() override;

  /// The port listened on.
  std::uint16_t port() const { return m_network.port(); }
  /// "127.0.0.1:9876".
  std::string address() const { return m_network.address(); }
  /// What players compare; nothing without encryption.
  std::optional<Fingerprint> fingerprint() const;
  /// What dfclient needs on its command line to join from this machine: "127.0.0.1:9876 --fingerprint …".
  std::string joinArguments() const;
  const Counters& counters() const { return m_counters; }
  /// What became of every datagram so far; nothing without encryption. Thread-safe.
  DatagramGateCounters datagramCounters() const { return m_network.gateCounters(); }
  /// How long ticks took, begin to last datagram sent. Thread-safe.
  const TickTimes& tickTimes() const { return m_network.tickTimes(); }
  void resetTickTimes() { m_network.resetTickTimes(); }
  /// Players whose streams are open. On the host's thread.
  std::size_t connected() const;
  /// A player who is alone and for whom the game is over (HostOptions::on_game_over) ends it for all.
  void setEndsWithLast(bool ends) { m_ends_with_last = ends; }
  /// How the last world failed, like "crashed (SIGABRT)"; empty if it did not. After run().
  const std::string& failure() const { return m_failure; }
  /// Ticks that were skipped for a player who is here (Session::skippedTicks); 0 for anybody else.
  std::uint64_t skippedTicks(std::uint32_t player) const;

  /// Makes a world that was not there before; throws std::system_error where that cannot be.
  using NewWorld = std::function<std::unique_ptr<WorldPort>(asio::io_context& home)>;
  /// run() hosts such worlds instead of the one that it is given: one after the other, or one for each player
  /// (HostOptions::players). That one says only what players are told when they join. Before run().
  void setWorlds(NewWorld new_world) { m_new_world = std::move(new_world); }

  /// Tick the world 30 times a second until the game is over, a signal comes or an option says so; then tell
  /// the players and let what is queued drain.
  void run(df::World& world) override;
  /// End run() after the present tick; players are told `sentence`. Callable from another thread.
  void stop(const std::string& sentence);
  /// Call `job` on the host's thread, between two ticks. Callable from another thread (tests look at a
  /// running world this way).
  void post(std::function<void(df::World&)> job);
  /// Called after every tick, on the host's thread.
  void setObserver(std::function<void(df::World&)> observer) { m_observer = std::move(observer); }

 private:
  using Clock = std::chrono::steady_clock;

  // Who comes in.
  void accept(std::unique_ptr<ReliableChannel> channel);
  void greet(Session& session, const wire::Hello& hello);
  std::size_t mostPlayers() const { return static_cast<std::size_t>(m_options.max_players); }
  std::size_t mostConnections() const;
  bool checkHello(Session& session, const wire::Hello& hello);
  void checkPassword(Session& session, const wire::Hello& hello);
  bool resume(Session& session, const wire::Hello& hello);
  void accompany(Session& session, const wire::Hello& hello);
  void admit(Session& session, const wire::Hello& hello);
  bool hasPlaceFor(Session& session);
  wire::Welcome welcomeTo(Room& room, const std::string& name);
  std::unique_ptr<SealedChannel> openDatagrams(const Session& session, const wire::Hello& hello);
  Session* find(std::uint64_t session);
  void chat(const Session& session, const std::string& text);
  void leave(Session& session);

  // Ticks.
  void adoptSettings(df::World& world);
  void serve();
  void tick();
  void afterTick(Room& room);
  void flush();
  void dismissLeavers(Room& room);
  void sendPlayers();
  void sweep();
  void drain();
  void logRefusals() const;
  bool isOver() const;
  bool isDeserted(Clock::time_point now) const;
  std::size_t playing() const;
  std::size_t fromSameAddress(const Session& session) const;

  // Worlds.
  std::uint32_t tickNumber() const { return static_cast<std::uint32_t>(m_counters.ticks); }
  bool isPrivate() const { return m_new_world && m_options.players == "private"; }
  Room& openRoom(std::unique_ptr<WorldPort> port);
  Room* roomForNewcomer();
  Room* roomOf(const Session& session) const;
  void lookAfterWorlds();
  void endRound(Room& room, const WorldEnd& end);
  bool beginRound(Room& room);
  void closeWorlds();

  template <class Visit>
  void forEachPlaying(Visit visit) {
    for (const auto& session : m_sessions) {
      if (session->state() == Session::State::kPlaying) visit(*session);
    }
  }

  HostOptions m_options;
  std::string m_game;
  Log m_log;
  Counters m_counters;
  asio::io_context m_io{1};  ///< this thread's handlers; no sockets
  std::optional<ServerIdentity> m_identity;
  NetworkThread m_network;
  std::unique_ptr<PasswordCheck> m_password;
  ResumeTokens m_tokens;
  std::uint64_t m_next_session = 1;
  std::vector<std::unique_ptr<Session>> m_sessions;  ///< by id
  NewWorld m_new_world;                              ///< empty: the world of run()
  std::vector<std::unique_ptr<Room>> m_rooms;
  std::optional<TruthWriter> m_truth;
  std::function<void(df::World&)> m_observer;
  df::World* m_p_world = nullptr;
  std::string m_stop_sentence;
  PlayerNews m_player_news;
  std::vector<df::PlayerFacts> m_players;  ///< of several rooms
  Clock::time_point m_empty_since;
  bool m_ever_joined = false;
  bool m_ends_with_last = false;
  bool m_worlds_over = false;  ///< there is no next round
  std::string m_failure;
  std::uint32_t m_next_player = 1;
  bool m_in_tick = false;
  Clock::time_point m_tick_began;
};

}  // namespace naiad
