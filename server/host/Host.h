// Hosts a game: the Runner behind GM.run() in dfserver.
//
// The thread that runs `run` owns world and sessions; the sockets have a thread of their own
// (NetworkThread.h). Between two ticks it hears what came on streams, at the deadline it runs the tick. `run`
// is the loop, `tick` one turn of it.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "AddressPrefix.h"
#include "Counters.h"
#include "HostOptions.h"
#include "LookBack.h"
#include "NetworkThread.h"
#include "PasswordCheck.h"
#include "PlayerNews.h"
#include "Publisher.h"
#include "ResumeTokens.h"
#include "Runner.h"
#include "ServerIdentity.h"
#include "Session.h"
#include "SoundNews.h"
#include "TruthFile.h"

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
  /// run() has ended because the game is over, and another round is to begin: players were not told goodbye,
  /// but are expected back.
  bool isRoundOver() const { return m_round_over; }
  /// Ticks that were skipped for a player who is here (Session::skippedTicks); 0 for anybody else.
  std::uint64_t skippedTicks(std::uint32_t player) const;

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

  void accept(std::unique_ptr<ReliableChannel> channel);
  void greet(Session& session, const wire::Hello& hello);
  bool checkHello(Session& session, const wire::Hello& hello);
  void checkPassword(Session& session, const wire::Hello& hello);
  bool resume(Session& session, const wire::Hello& hello);
  void admit(Session& session, const wire::Hello& hello);
  std::unique_ptr<SealedChannel> openDatagrams(const Session& session, const wire::Hello& hello);
  Session* find(std::uint64_t session);
  Session* findPlayer(std::uint32_t player);
  void chat(const Session& session, const std::string& text);
  void adoptSettings(df::World& world);
  void leave(Session& session);
  void serve();
  void tick(df::World& world);
  void giveTurn();
  void tellTurn(Session& session);
  bool isHeard(const Session& session, const Input& input) const;
  void applyInputs(df::World& world);
  void dismissLeavers(df::World& world);
  bool wantsNextRound(const df::World& world) const;
  void lookBack(df::World& world);
  void sendSnapshots(df::World& world);
  void sendPlayers(const df::World& world);
  void sendSounds(const df::World& world);
  void sendNotes(const df::World& world);
  Session* findTicking(std::uint32_t player) const;
  void writeTruth(const df::PlayerFacts& player, const df::World& world);
  void sweep();
  void drain();
  void logRefusals() const;
  bool isOver(const df::World& world) const;
  bool isDeserted(Clock::time_point now) const;
  std::size_t playing() const;
  std::size_t fromSameAddress(const Session& session) const;
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
  Publisher m_publisher;
  std::optional<LookBack> m_look_back;  ///< while the game wants it
  std::optional<TruthWriter> m_truth;
  std::function<void(df::World&)> m_observer;
  df::World* m_p_world = nullptr;
  std::string m_stop_sentence;
  PlayerNews m_player_news;
  SoundNews m_sound_news;
  std::vector<Session*> m_by_player;  ///< those that play, by player; for one tick
  Clock::time_point m_empty_since;
  bool m_ever_joined = false;
  bool m_ends_with_last = false;
  bool m_round_over = false;
  std::uint32_t m_turn = 0;         ///< the player whose input is heard, if only one's is; 0: nobody
  std::uint32_t m_turn_before = 0;  ///< whose was before him: keys that he held are let go
};

}  // namespace naiad
