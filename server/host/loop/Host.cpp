#include "host/loop/Host.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>
#include <utility>

#include "engine/managers/GameManager.h"
#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "host/admission/Places.h"
#include "host/metrics/MetricsAddress.h"
#include "host/metrics/MetricsServer.h"
#include "host/ops/NetworkReport.h"
#include "host/process/CrashReport.h"
#include "host/process/StopSignals.h"
#include "host/rooms/ServerLine.h"
#include "host/rounds/RoundHandover.h"
#include "host/session/LookAlikes.h"
#include "naiad.pb.h"
#include "shared/program/BrokenPipes.h"
#include "shared/program/LogText.h"
#include "shared/program/OpenFiles.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kLate{5};
constexpr std::chrono::milliseconds kMinService{5};  ///< for sockets, however late the tick is
constexpr int kMinHandlers = 16;                     ///< the same; one handler may serve many messages
constexpr std::chrono::seconds kDrainTime{1};
constexpr std::chrono::milliseconds kDrainStep{10};   ///< between two looks at worlds that end
constexpr std::chrono::seconds kFirstPlayerTime{60};  ///< --exit-when-empty before the first player joins
constexpr int kLongestFrameMillis = 1000;             ///< as --frame-time
constexpr int kExitHung = 1;                          ///< as for a game that fails
constexpr const char* kShuttingDown = "The server is shutting down.";  // as Ending says it

TcpOptions channelOptions() {
  TcpOptions options;
  options.receive_limit = kMaxHelloFrame;
  return options;
}

/// The key that TLS proves; nothing without encryption.
std::optional<ServerIdentity> identityOf(const HostOptions& options) {
  if (options.insecure) return std::nullopt;
  if (!options.certificate.empty()) return ServerIdentity::load(options.certificate, options.key);
  const auto directory =
      options.identity.empty() ? ServerIdentity::defaultDirectory() : std::filesystem::path(options.identity);
  return ServerIdentity::loadOrMake(directory, std::chrono::system_clock::now());
}

// As if the signal had not been handled: its sender sees that it was.
void endBySignal(int signal) {
  ::signal(signal, SIG_DFL);
  sigset_t one;
  sigemptyset(&one);
  sigaddset(&one, signal);
  pthread_sigmask(SIG_UNBLOCK, &one, nullptr);
  ::kill(getpid(), signal);
}

}  // namespace

Host::Host(HostOptions options, std::string game, Log log)
    : m_options(std::move(options)),
      m_log(m_feed.watched(std::move(log))),
      m_bans(m_admin_worker, m_options.state),
      m_identity(identityOf(m_options)),
      m_handshakes(PrefixRates::handshakes(m_options.max_per_address)),
      m_stream_refusals(m_io, m_client_log),
      m_network(
          m_io, m_options.address, static_cast<std::uint16_t>(m_options.port),
          [this](std::unique_ptr<ReliableChannel> channel) {
            m_sessions.add(std::move(channel), sessionEvents(), Clock::now());
          },
          channelOptions(), listening(), NetworkThread::Limits(), visitors(), m_options.sockets),
      m_listing(m_options, listedAs(game), m_log),
      m_sessions(maxConnections(m_options), m_counters,
                 [this](Session& session) { m_rooms.removeSession(session); }),
      m_scores(m_options.state, game),
      m_rooms(
          m_options, m_sessions, m_counters, m_log, [this] { flush(); }, m_stages),
      m_client_log(m_log),
      m_admission({m_options, std::move(game), m_sessions, m_rooms, m_prefixes, m_counters, m_bans,
                   [this](const std::string& address, LogEvent event) {
                     m_client_log.logNews(address, std::move(event), m_network.now());
                   },
                   [this](const auto& stream, AeadId aead) { return m_network.openDatagrams(stream, aead); },
                   [this] { m_player_news.repeat(); }, [this] { return m_ending.isOpen(); },
                   [this](const wire::Welcome& welcome) -> Session& {
                     Session& session = m_sessions.addDetached(Clock::now());
                     session.restore(welcome, sessionEvents());
                     return session;
                   },
                   [this] { return m_fleet.linkToOther(Clock::now()); }},
                  m_io.get_executor()),
      m_room_moves({m_sessions, m_rooms, m_admission, m_counters,
                    [this](const std::string& address, LogEvent event) {
                      m_client_log.logNews(address, std::move(event), m_network.now());
                    }}),
      m_chat(PrefixRates::chat(m_options.max_per_address)),
      m_commands(
          {{m_options, m_sessions, m_rooms, m_admission, m_counters, m_network, m_scores, adminControls()},
           m_bans,
           m_admin_worker,
           m_feed,
           m_client_log,
           m_log},
          m_io),
      m_fleet(fleetSetup()),
      m_empty_since(Clock::now()) {
  surviveBrokenPipes();
  m_rooms.setScores(m_scores);
  m_scores.setObserver([this](const ScoreRow& row) { m_fleet.noteScore(row, m_admission.game()); });
  m_rooms.watchRounds([this](const Room& room) { m_admission.noteSessions(room); },
                      [this](Room& room, const std::vector<KeptSession>& sessions) {
                        m_admission.restoreSessions(room, sessions);
                      });
  m_rooms.watchSent(
      [this](Session& session, const std::string& room) { m_room_moves.askByGame(session, room); });
  m_rooms.watchClosed(
      [this](const Room& room, const std::string& sentence) { m_room_moves.leadAway(room, sentence); });
  openMetrics();
  for (const std::string& warning : m_options.warnings) m_log(LogEvent::warning(warning));
  if (m_identity && !m_identity->warning().empty()) m_log(LogEvent::warning(m_identity->warning()));
  m_commands.listen();
  shapesOf({});  // loads the tables now: the tick of the first join should not wait for them
  makePlaces();
}

// For as many players as may join by now.
void Host::makePlaces() {
  m_sessions.setMost(maxConnections(m_options));
  const std::size_t wanted = wantedFiles(m_options);
  if (const std::size_t files = allowOpenFiles(wanted); files < wanted) {
    m_log("only " + std::to_string(files) + " files may be open (ulimit -Hn): too few for " +
          std::to_string(m_options.max_players) + " players and those who come back");
  }
}

AdminControls Host::adminControls() {
  return {[this](Ending::Plan plan) { end(std::move(plan)); },
          [this](std::function<void()> job) { asio::post(m_io, std::move(job)); },
          [this] { return cancelEnd(); },
          [this](Reloading done) { reload(std::move(done)); },
          [this](Reloading done) { keepRound(std::move(done)); },
          [this](const HostOptions& options) {
            takeOver(options, m_options);
            makePlaces();
          }};
}

// A port that is taken is an error as the players' port is.
void Host::openMetrics() {
  if (m_options.metrics.empty()) return;
  try {
    m_metrics = std::make_unique<HostMetrics>(
        HostMetrics::Sources{m_options, m_counters, m_network, m_sessions, m_rooms, m_admission, m_stages});
  } catch (const MetricsError& error) {
    throw ListenError(error.what(), std::make_error_code(std::errc::address_in_use));
  }
  m_log("metrics are at http://" + MetricsAddress::parse(m_options.metrics)->hostText() + ":" +
        std::to_string(m_metrics->port()) + "/metrics");
}

void Host::beginMetrics() {
  if (!m_metrics) return;
  const auto tick = TickLength::fromMicros(m_options.frame_micros).times(1);
  m_metrics->begin(tick);
  if (m_options.audit == "on") m_rooms.startAudit(static_cast<std::uint32_t>(std::chrono::seconds(1) / tick));
}

// Answers go through what is destroyed here.
Host::~Host() {
  m_commands.close();
  m_scores.finish();
  for (const auto& [game, p_scores] : m_room_scores) p_scores->finish();
}

void Host::setWorlds(NewWorld new_world, std::uint32_t highest_player) {
  m_admission.reservePlayers(highest_player);
  m_rooms.setWorlds([this, new_world = std::move(new_world)] { return new_world(m_io); });
}

// The server's loop: serve sockets until the next tick is due, then tick.
void Host::run(df::World& world) {
  beginGame(world);
  StopSignals signals;
  SideLog side_log(m_log);
  Watchdog watchdog(
      signals, [&side_log](const std::string& line) { side_log(line); },
      [this, &side_log](const ForcedEnd& end) { endProcess(end, side_log); });
  m_p_watchdog = &watchdog;
  TickClock schedule(Clock::now(), TickLength::fromMicros(m_options.frame_micros));
  const auto work = asio::make_work_guard(m_io);  // or waiting for a deadline would end at once
  m_network.start();
  m_fleet.begin();
  beginMetrics();
  m_listing.start();
  while (!isOver()) {
    serveUntil(schedule.deadline());
    heedSignals(signals);
    if (isDue(schedule)) tick();
    if (m_metrics) m_metrics->update(Clock::now());
  }
  drain();
  m_p_watchdog = nullptr;
  endGame(world);
}

// The first SIGTERM lets players finish, if there is time for that; a second signal ends all (Watchdog.h).
void Host::heedSignals(StopSignals& signals) {
  const Clock::time_point now = Clock::now();
  if (signals.count() > std::exchange(m_heeded_signals, signals.count())) {
    const bool waits = signals.signal() == SIGTERM && m_options.drain_time > 0;
    endWhenEmpty(waits ? m_options.drain_time : 0);
    if (waits) m_log("SIGTERM: no new players; ending when all have left");
  }
  if (!signals.takeHangUp()) return;
  LineLog::reopenAll();
  m_log("SIGHUP: the log goes on in this file (there is no terminal, so the server does too)");
  if (!m_reload) return;
  m_fleet.noteReloading(now);
  reload([this](bool, const std::string& sentence) {
    m_fleet.begin();
    m_log(sentence);
  });
}

void Host::endWhenEmpty(double seconds) {
  const auto patience = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  end({.at = Clock::now() + patience, .when_empty = true});
}

void Host::end(Ending::Plan plan) {
  if (plan.at_round_end && (m_rooms.isPrivate() || m_rooms.isNamed()))
    plan.at_round_end = !(plan.when_empty = true);
  m_rooms.setLastRound(plan.at_round_end);
  m_keeps_round = false;
  m_ending.setPlan(std::move(plan), Clock::now());
  if (m_metrics && !m_ending.isOpen()) m_metrics->beginDrain(true);
}

bool Host::cancelEnd() {
  m_rooms.setLastRound(false);
  m_rooms.forgetUpgrade();
  m_keeps_round = false;
  if (m_metrics) m_metrics->cancelDrain();
  return m_ending.cancel();
}

void Host::heedEnd(Clock::time_point now) {
  if (const auto news = m_ending.takeNews(now)) sayToAll(*news);
}

// The worlds that there are go on; the next ones take a server that is of their build.
void Host::heedUpgrade() {
  const auto news = m_rooms.takeUpgrade();
  if (!news) return;
  const bool waits = m_rooms.isPrivate();
  m_log(LogEvent::warning(*news + (waits ? "; it begins again when all have left" : "; it begins again")));
  Ending::Plan plan = m_ending.plan().value_or(Ending::Plan{.begins_again = true});
  if (waits) {
    plan.when_empty = true;
  } else {
    plan.at = m_tick_began;
  }
  end(std::move(plan));
}

void Host::sayToAll(const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(text);
  m_sessions.forEachPlaying([&message](Session& session) { session.sendKept(message); });
}

// On the watchdog's thread. The game may hold any lock of the process, that of the log too, so nothing is
// destroyed, and the log is not waited for without end.
void Host::endProcess(const ForcedEnd& end, SideLog& log) {
  log(end.hung ? "ended without the game, which does not finish tick " + std::to_string(end.tick) +
                     crash::activity("handles")
               : std::string("ended at once by a second signal"));
  wire::ServerMessage message;
  message.mutable_goodbye()->set_sentence(kShuttingDown);
  m_network.sendLast(message.SerializeAsString(), kDrainTime);
  m_fleet.sayLast(kDrainTime);
  log.waitUntilLogged(kDrainTime);
  LineLog::waitUntilWritten(kDrainTime);
  if (!end.hung) endBySignal(end.signal);
  _exit(kExitHung);
}

void Host::beginGame(df::World& world) {
  m_p_world = &world;
  crash::setWorld(world);
  adoptSettings(world);
  m_admission.setWorld(world);
  m_rooms.open(world);
  m_empty_since = Clock::now();
}

void Host::endGame(df::World& world) {
  m_rooms.clear();
  world.input().setGameOverLeaves(false);
  crash::clearWorld(world);
  m_p_world = nullptr;
}

// Takes over what the game asks for, unless an option says otherwise.
void Host::adoptSettings(df::World& world) {
  if (const df::WorldExtras* p_extras = world.findExtras()) {
    // 33 ms is how the published engine writes 1/30 s.
    const int millis = std::min(p_extras->settings.frame_time, kLongestFrameMillis);
    if (m_options.frame_micros == 0 && millis != df::FRAME_TIME_DEFAULT)
      m_options.frame_micros = millis * 1000;
  }
  world.input().setGameOverLeaves(m_options.on_game_over != "exit");
  if (world.compat()) m_log("compat is on: the published engine's rules where they differ from the book's");
}

// Even when the deadline has passed, a least number of handlers runs: an overloaded server must go on hearing
// its clients. It does not run all that are ready, though: one client that floods would stop the world.
void Host::serveUntil(Clock::time_point deadline) {
  m_io.restart();
  const auto enough = Clock::now() + kMinService;
  for (int served = 0; m_io.poll_one() > 0; ++served) {
    if (served >= kMinHandlers && Clock::now() >= enough) break;
  }
  m_io.run_until(deadline);
  sweep();
}

bool Host::isDue(TickClock& schedule) {
  const Clock::time_point now = Clock::now();
  if (now < schedule.deadline()) return false;
  if (m_metrics) m_metrics->beginTick(m_counters.ticks + 1, schedule.deadline(), now);
  m_counters.late_ticks += now - schedule.deadline() > kLate ? 1 : 0;
  m_counters.rebased_ticks += schedule.beginTick(now) ? 1 : 0;
  return true;
}

// One tick: input -> world (step, input events, update, draw) -> published models -> snapshots. A world in a
// process of its own ends its tick later, and what it publishes is flushed then.
void Host::tick() {
  m_tick_began = Clock::now();
  m_stages.enter(Stage::kReceive);
  m_network.serve(m_tick_began + kMinService);  // the datagrams since the last one
  m_stages.enter(Stage::kSessions);
  checkSessions();
  heedEnd(m_tick_began);
  ++m_counters.ticks;
  m_client_log.update(m_tick_began);
  m_rooms.checkWorlds();
  m_admission.judgeWaiting();
  m_room_moves.update();
  heedUpgrade();
  tickWorlds();
  m_stages.enter(Stage::kNews);
  sendPlayers();
  flush();
  m_fleet.tick(m_tick_began);
  m_stages.enter(Stage::kBetween);
  if (m_observer) m_observer(*m_p_world);
}

// The game's code runs in here alone, unless it is in processes of its own.
void Host::tickWorlds() {
  const std::uint64_t number = m_p_world->picture().view().tick + 1;
  m_p_watchdog->beginTick(number);
  crash::noteTick(number);
  m_rooms.beginTicks();
  crash::noteTick(0);
  m_p_watchdog->endTick();
}

void Host::checkSessions() {
  const Clock::time_point now = Clock::now();
  m_sessions.forEach([&](Session& session) {
    session.checkDeadlines(now);
    if (session.takeProof()) m_admission.confirmToken(session);
    m_inactivity.check(session, std::chrono::seconds(m_options.inactive_kick), m_counters, sendServerLine);
  });
  m_commands.update(now);
}

HostFleet::Setup Host::fleetSetup() {
  return {m_options,
          m_sessions,
          m_network,
          m_counters,
          m_admission.game(),
          m_identity ? m_identity->fingerprint().text() : "",
          m_log,
          [this] { return m_ending.isOpen(); },
          [this] { return presenceOfRooms(m_rooms); },
          [this] {
            m_log("the platform shuts the server down");
            endWhenEmpty(m_options.drain_time);
          }};
}

// The list of players has those of all rooms.
void Host::sendPlayers() {
  const std::size_t playing = m_sessions.playing();
  m_listing.setPlayers(playing);
  if (playing == 0) return;
  m_player_news.tick(
      static_cast<std::uint32_t>(m_counters.ticks), m_rooms.players(),
      [this](std::uint32_t player) {
        const Session* p_session = m_rooms.findPlayer(player);
        return p_session != nullptr ? p_session->rttMillis() : 0;
      },
      [this](std::uint32_t player, const wire::ServerMessage& message) {
        if (Session* p_session = m_rooms.findPlayer(player)) p_session->sendKept(message);
      });
}

// The flush after the last room's tick ends the host's tick.
void Host::flush() {
  const Stage before = m_stages.enter(Stage::kFlush);
  if (m_rooms.isTicking()) {
    m_network.flush();
  } else {
    m_network.flushTick(m_tick_began);
    if (m_metrics) m_metrics->endTick(Clock::now());
  }
  m_stages.enter(before);
}

void Host::sweep() {
  m_sessions.sweep();
  if (connected() > 0) m_empty_since = Clock::now();
}

// ---- callbacks of sessions --------------------------------------------------------------------------------

Session::Events Host::sessionEvents() {
  return {[this](Session& session, const wire::Hello& hello) { m_admission.judgeHello(session, hello); },
          [this](Session& session, const std::string& text) { takeChat(session, text); },
          [this](Session& session) { endSession(session); },
          [this] { return m_network.now(); },
          [this](Session& session, const std::string& sentence) {
            m_client_log.logRefusal(session.address(), sentence, m_network.now());
          },
          [this](Session& session) { m_room_moves.sendList(session); },
          [this](Session& session, const std::string& room) { m_room_moves.ask(session, room); }};
}

// A command is for the server alone, whatever becomes of it.
void Host::takeChat(Session& session, const std::string& text) {
  const auto prefix = AddressPrefix::ofEndpoint(session.address()).value_or(AddressPrefix());
  if (!m_chat.take(prefix, m_network.now())) {
    ++m_counters.chat_dropped;
  } else if (ChatCommands::isCommand(text)) {
    m_commands.serveChat(session, text);
  } else if (session.standing().isMuted()) {
    ++m_counters.chat_muted;
    sendServerLine(session, "You are muted: nobody reads your lines.");
  } else {
    sendChat(session, text);
  }
}

void Host::sendChat(const Session& session, const std::string& text) {
  m_feed.publish("chat", inQuotes(session.name()) + ": " + text);
  if (m_options.log_chat) {
    m_client_log.logNews(session.address(),
                         {"chat",
                          inQuotes(session.name()) + " says " + inQuotes(text),
                          {{"player", session.name()}, {"line", text}}},
                         m_network.now());
  }
  wire::ServerMessage message;
  message.mutable_chat()->set_player(session.player());
  message.mutable_chat()->set_text(text);
  m_sessions.forEachPlaying([&](Session& other) { other.sendKept(message); });
}

void Host::endSession(Session& session) {
  m_admission.forgetSession(session);
  m_inactivity.forget(session);
  if (session.player() == 0) return;
  m_rooms.leave(session);
  m_client_log.logNews(session.address(),
                       {"left", inQuotes(session.name()) + " left", {{"player", session.name()}}},
                       m_network.now());
}

// ---- the end ----------------------------------------------------------------------------------------------

bool Host::isDeserted(Clock::time_point now) const {
  if (m_options.exit_when_empty <= 0 || connected() > 0) return false;
  const std::chrono::duration<double> patience(m_options.exit_when_empty);
  const bool ever_joined = m_counters.joined > 0;
  return now - m_empty_since >
         (ever_joined ? patience : std::max<std::chrono::duration<double>>(patience, kFirstPlayerTime));
}

bool Host::isOver() const {
  const bool counted_out =
      m_options.ticks > 0 && m_counters.ticks >= static_cast<std::uint64_t>(m_options.ticks);
  const Clock::time_point now = Clock::now();
  // A player whose connection broke may come back, so they are waited for, too.
  const bool is_due = m_ending.plan() && m_ending.isDue(now, m_sessions.playing() == 0);
  return m_rooms.isOver() || is_due || counted_out || isDeserted(now);
}

// Players of a round that is kept lose the server, as if it had been killed.
void Host::drain() {
  m_is_draining = true;
  if (keepsRound()) m_p_handover->leaveOpen(port());
  m_fleet.noteStopping();
  if (m_metrics) m_metrics->beginDrain(false);
  m_network.closeListener();
  m_listing.stop();
  std::string sentence = m_rooms.lastSentence();
  if (sentence.empty() || m_ending.beginsAgain()) sentence = m_ending.sentence();
  if (sentence.empty()) sentence = "The game is over.";
  const auto again = m_ending.beginsAgain() ? Ending::kLookAgain : std::chrono::seconds(0);
  if (!keepsRound()) m_sessions.forEach([&](Session& session) { session.goodbye(sentence, again); });
  m_rooms.closeWorlds();
  m_network.flush();
  const Clock::time_point end = Clock::now() + kDrainTime;
  const auto are_players_left = [this] { return !keepsRound() && !m_sessions.isEmpty(); };
  while ((are_players_left() || !m_rooms.isEmpty()) && Clock::now() < end) {
    m_io.restart();
    m_io.run_one_until(m_rooms.isEmpty() ? end : std::min(end, Clock::now() + kDrainStep));
    sweep();
    m_rooms.closeWorlds();
  }
  m_network.stop();
  m_commands.close();
  m_rooms.finishScores();
  m_fleet.finish();
  m_client_log.finish();
  m_log("stopped: " + m_counters.summary());
  logPasswords(m_admission.passwordCounters(), m_log);
  logRefusals(m_network, m_log);
  m_listing.logCounters();
}

void Host::stop(const std::string& sentence) {
  asio::post(m_io, [this, sentence] { end({.at = Clock::time_point(), .sentence = sentence}); });
}

void Host::post(std::function<void(df::World&)> job) {
  asio::post(m_io, [this, job = std::move(job)] { job(*m_p_world); });
}

}  // namespace naiad
