// Hosts a game: the Runner behind GM.run() in dfserver.
//
// The thread that runs `run` owns worlds and sessions; the sockets have a thread of their own
// (NetworkThread.h). Between two ticks it serves streams, at the deadline it runs the tick. `run` is the
// loop, `tick` one turn of it. Admission.h decides which clients play, Rooms.h in which world.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/Runner.h"
#include "host/admin/AdminWorker.h"
#include "host/admin/BanList.h"
#include "host/admin/WatchFeed.h"
#include "host/admission/Admission.h"
#include "host/admission/RoomMoves.h"
#include "host/auth/ServerIdentity.h"
#include "host/loop/Reload.h"
#include "host/metrics/StageClock.h"
#include "host/net/NetworkThread.h"
#include "host/net/PlayerPrefixes.h"
#include "host/ops/HostCommands.h"
#include "host/ops/HostFleet.h"
#include "host/ops/HostMetrics.h"
#include "host/ops/InactivityCheck.h"
#include "host/ops/Listing.h"
#include "host/ops/StreamRefusalLog.h"
#include "host/process/Ending.h"
#include "host/process/SideLog.h"
#include "host/process/TickClock.h"
#include "host/process/Watchdog.h"
#include "host/rooms/PlayerNews.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "host/rounds/RoomPlan.h"
#include "host/scores/ScoreKeeper.h"
#include "host/session/Counters.h"
#include "host/settings/HostOptions.h"
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/program/ClientLog.h"
#include "shared/program/LineLog.h"

namespace naiad {

class RoundHandover;

class Host : public df::Runner {
 public:
  using Log = LogLine;

  /// Listens from now on (clients wait until run()). Throws ListenError (with HostOptions::lan "on" for the
  /// socket of the local network's queries, too), TlsError for keys that cannot be used, or
  /// std::runtime_error for a truth or status file that cannot be written.
  Host(HostOptions options, std::string game, Log log);
  ~Host() override;

  /// The port listened on.
  std::uint16_t port() const { return m_network.port(); }
  /// "127.0.0.1:9876".
  std::string address() const { return m_network.address(); }
  /// The port on which metrics are given out; 0: they are not.
  std::uint16_t metricsPort() const { return m_metrics ? m_metrics->port() : 0; }
  /// What players compare; nothing without encryption.
  std::optional<Fingerprint> fingerprint() const;
  /// What dfclient needs on its command line to join from this machine: "127.0.0.1:9876 --fingerprint …".
  std::string joinArguments() const;
  /// The link for players of this machine, or of any machine if HostOptions::link_host is given and
  /// `elsewhere` asked for. Nothing without encryption.
  std::optional<JoinLink> joinLink(bool elsewhere) const;
  const Counters& counters() const { return m_counters; }
  /// Of the socket for commands; empty: there is none.
  const std::string& controlPath() const { return m_commands.path(); }
  /// What became of every datagram so far; nothing without encryption. Thread-safe.
  DatagramGateCounters datagramCounters() const { return m_network.gateCounters(); }
  /// How long ticks took, begin to last datagram sent. Thread-safe.
  const TickTimes& tickTimes() const { return m_network.tickTimes(); }
  void resetTickTimes() { m_network.resetTickTimes(); }
  /// Players whose streams are open. On the host's thread.
  std::size_t connected() const { return m_sessions.connected(); }
  /// When the game is over for a player who is alone (HostOptions::on_game_over), it is over for all.
  void setEndsWithLast(bool ends) { m_rooms.setEndsWithLast(ends); }
  /// How the last world failed, like "crashed (SIGABRT)"; empty if it did not. After run().
  const std::string& failure() const { return m_rooms.failure(); }
  /// Ticks skipped for this player (Session::skippedTicks); 0 if there is none.
  std::uint64_t skippedTicks(std::uint32_t player) const { return m_sessions.skippedTicks(player); }

  /// Begins a round in a world that was not there before; throws std::system_error where that cannot be.
  using NewWorld = std::function<std::unique_ptr<Round>(asio::io_context& home)>;
  /// run() hosts such worlds instead of the one that it is given: one after the other, or one for each player
  /// (HostOptions::players). From the one it is given it takes only what welcomes say. New players get ids
  /// above `highest_player`, which the first world may have seen. Before run().
  void setWorlds(NewWorld new_world, std::uint32_t highest_player = 0);
  /// A room by name, with what makes its worlds (the plan's own new_world and p_scores are set here).
  struct NamedRoom {
    RoomPlan plan;
    NewWorld new_world;
  };
  /// run() hosts these instead. Players begin in the first. Before run().
  void setRooms(std::vector<NamedRoom> rooms);

  /// Tick the world 30 times a second until the game is over, a signal comes or an option says so; then send
  /// the players a goodbye and let what is queued drain. If the game does not return from a tick, and a
  /// signal comes, or if a second one does, the process ends from here, with a goodbye: with code 1, or by
  /// the signal.
  void run(df::World& world) override;
  /// End run() after the present tick, with this sentence to the players. Callable from another thread.
  void stop(const std::string& sentence);
  /// End run() so; at the end of a round, where each player has a world of their own, is when all have left.
  /// On the host's thread.
  void end(Ending::Plan plan);
  /// Do not end after all. False: nothing was planned. On the host's thread.
  bool cancelEnd();
  /// What is planned, if anything. On the host's thread.
  const Ending& ending() const { return m_ending; }
  /// run() has ended so that the server begins again; its clients look for it.
  bool beginsAgain() const { return m_ending.beginsAgain(); }

  /// Reads the options again, on a thread of its own. Throws what says why it cannot.
  using ReadOptions = Reload::ReadOptions;
  /// SIGHUP without a terminal reads them so, and takes over what may change while it runs. Before run().
  void setReload(ReadOptions read) { m_reload.emplace(std::move(read)); }
  /// The same now. Files are read and passwords hashed on a thread of their own; then `done` is called on the
  /// host's thread: whether they could be used, and what has changed, in words. Options that cannot be used,
  /// and those that need a restart, leave what there was. On the host's thread.
  using Reloading = std::function<void(bool is_done, const std::string& sentence)>;
  void reload(Reloading done);
  /// For lines of its game, which those who watch the server read, too (WatchFeed.h). Outlives what it gives.
  LogLine watchedGame(LogLine log) { return m_feed.watchedGame(std::move(log)); }
  /// What `restart --keep` works with; outlives run(). Before run().
  void setHandover(RoundHandover& handover) { m_p_handover = &handover; }
  /// Begin again in the program that is installed by now, with the round that is being played. `done` is
  /// called on the host's thread once that has been tried out: whether it can be, and a sentence without its
  /// end. If not, the server begins again when all have left; or nothing has changed, for there is no round
  /// to try it with. On the host's thread.
  void keepRound(Reloading done);
  /// run() has ended so that another program goes on with the round.
  bool keepsRound() const { return m_keeps_round && beginsAgain(); }
  /// Call `job` on the host's thread, between two ticks. Callable from another thread (tests inspect a
  /// running world with it).
  void post(std::function<void(df::World&)> job);
  /// Called after every tick, on the host's thread.
  void setObserver(std::function<void(df::World&)> observer) { m_observer = std::move(observer); }

 private:
  using Clock = std::chrono::steady_clock;

  TlsListening listening();
  VisitorsListening visitors() const;
  void openMetrics();
  void beginMetrics();
  Listing::Server listedAs(const std::string& game) const;
  ScoreKeeper& scoresOf(const std::string& game);
  Session::Events sessionEvents();
  void takeChat(Session& session, const std::string& text);
  void sendChat(const Session& session, const std::string& text);
  void endSession(Session& session);
  void beginGame(df::World& world);
  void endGame(df::World& world);
  void adoptSettings(df::World& world);
  void serveUntil(Clock::time_point deadline);
  bool isDue(TickClock& schedule);
  void tick();
  void tickWorlds();
  void endWhenEmpty(double seconds);
  void heedSignals(StopSignals& signals);
  void heedEnd(Clock::time_point now);
  void heedUpgrade();
  void sayToAll(const std::string& text);
  void adoptReloaded(Reloaded reloaded, const Reloading& done);
  void finishProof(const std::string& problem, const Reloading& done);
  void endWithoutRound(const std::string& problem, const Reloading& done);
  AdminControls adminControls();
  void makePlaces();
  void useIdentity(std::optional<ServerIdentity> identity);
  [[noreturn]] void endProcess(const ForcedEnd& end, SideLog& log);
  void checkSessions();
  void sendPlayers();
  HostFleet::Setup fleetSetup();
  void flush();
  void sweep();
  void drain();
  bool isOver() const;
  bool isDeserted(Clock::time_point now) const;

  HostOptions m_options;
  WatchFeed m_feed;
  Log m_log;
  Counters m_counters;
  asio::io_context m_io{1};  ///< this thread's handlers; no sockets
  AdminWorker m_admin_worker;
  BanList m_bans;  ///< the network thread asks it, too
  std::optional<ServerIdentity> m_identity;
  PlayerPrefixes m_prefixes;
  PrefixAllowance m_handshakes;  ///< of the network thread
  StreamRefusalLog m_stream_refusals;
  NetworkThread m_network;
  Listing m_listing;
  SessionTable m_sessions;
  StageClock m_stages;
  ScoreKeeper m_scores;
  std::map<std::string, std::unique_ptr<ScoreKeeper>> m_room_scores;  ///< of the other rooms' games
  Rooms m_rooms;
  ClientLog m_client_log;
  Admission m_admission;
  RoomMoves m_room_moves;
  PrefixAllowance m_chat;
  Watchdog* m_p_watchdog = nullptr;  ///< while it runs
  PlayerNews m_player_news;
  HostCommands m_commands;
  InactivityCheck m_inactivity;
  HostFleet m_fleet;
  std::function<void(df::World&)> m_observer;
  df::World* m_p_world = nullptr;
  Ending m_ending;
  std::optional<Reload> m_reload;
  RoundHandover* m_p_handover = nullptr;  ///< null: no round can be kept
  bool m_keeps_round = false;
  bool m_is_draining = false;
  int m_heeded_signals = 0;
  Clock::time_point m_empty_since;
  Clock::time_point m_tick_began;
  std::unique_ptr<HostMetrics> m_metrics;  ///< null: none are wanted
};

}  // namespace naiad
