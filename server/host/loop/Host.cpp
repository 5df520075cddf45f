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
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/loop/HostPart.h"
#include "host/loop/OperatorLibrary.h"
#include "host/process/CrashReport.h"
#include "host/process/StopSignals.h"
#include "host/process/TickClock.h"
#include "host/process/Watchdog.h"
#include "host/session/CounterTable.h"
#include "naiad.pb.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kLate{5};
constexpr std::chrono::milliseconds kMinService{5};  ///< minimum time for sockets, however late the tick is
constexpr int kMinHandlers = 16;                     ///< minimum number of handlers run for sockets
constexpr std::chrono::seconds kDrainTime{1};
constexpr std::chrono::milliseconds kDrainStep{10};  ///< interval of checks whether worlds have ended
constexpr double kFirstPlayerSeconds = 60;           ///< minimum of --exit-when-empty until a player joins
constexpr std::chrono::milliseconds kRestTime{400};  ///< time between two ticks while no world ticks
constexpr int kMaxFrameTimeMillis = 1000;  ///< limit of a game's frame_time, like that of --frame-time
constexpr int kExitHung = 1;               ///< exit code of a hung game, as of one that fails
constexpr const char* kShuttingDown = "The server is shutting down.";  // like ShutdownScheduler's sentence

// Ends the process by the signal's default action, so that its exit status shows the signal.
void endBySignal(int signal) {
  ::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  pthread_sigmask(SIG_SETMASK, &none, nullptr);
  ::kill(getpid(), signal);
}

}  // namespace

Host::Host(HostOptions options, std::string game, Log log)
    : m_context(std::make_unique<HostContext>(std::move(options), std::move(game), std::move(log))),
      m_endpoint(std::make_unique<HostEndpoint>(
          *m_context,
          [this](std::unique_ptr<ReliableChannel> channel) { m_clients->add(std::move(channel)); })),
      m_clients(std::make_unique<HostClients>(*m_context, *m_endpoint, [this] { flush(); })),
      m_controls(std::make_unique<HostControls>(*m_context, *m_endpoint, *m_clients)),
      m_empty_since(Clock::now()) {
  ignoreBrokenPipes();
  for (const std::string& warning : m_context->options.warnings) m_context->log(LogEvent::warning(warning));
  m_parts = makeOperatorParts({*m_context, *m_endpoint, *m_clients, *m_controls});
}

// Stops the network thread, which calls the parts destroyed here. It still runs if a game has thrown.
Host::~Host() {
  m_endpoint->network().stop();
}

// Serves sockets until the next tick is due, then ticks, in a loop.
void Host::run(df::World& world) {
  if (m_finished) return world.setGameOver();
  const bool is_first = !awaitsRun();
  if (is_first) {
    beginGame(world);
  } else {
    serveUntil(Clock::now());  // players that left since the last run must not join again
    world.setGameOver(false);
    m_clients->rooms().restart();
  }
  const auto length = TickLength::fromMicros(m_context->options.frame_micros);
  StopSignals signals;
  AsyncLog side_log(m_context->log);
  Watchdog watchdog(
      signals, length.times(1), [&side_log](const std::string& line) { side_log(line); },
      [this, &side_log](const ForcedExit& end) { endProcess(end, side_log); });
  TickClock schedule(Clock::now(), length);
  const auto work = asio::make_work_guard(m_context->home);  // without it, run_until() would return at once
  m_endpoint->network().start();
  for (const auto& part : m_parts) is_first ? part->begin() : void();
  while (!isOver()) {
    serveUntil(schedule.deadline());
    m_controls->handleSignals(signals);
    if (isDue(schedule)) tick(watchdog);
    if (isResting()) schedule = rest();
  }
  if (!m_clients->rooms().mayRestart() || m_context->shutdown_scheduler.plan()) finish();
}

void Host::finish() {
  if (!awaitsRun()) return;
  m_finished = true;
  drain();
  endGame(*m_p_world);
}

// Runs on the watchdog's thread. The game may hold any lock of the process, including the log's. So nothing
// is destroyed, and waiting for the log has a time limit.
void Host::endProcess(const ForcedExit& end, AsyncLog& log) {
  log(end.hung ? "forced to exit: the game does not finish tick " + std::to_string(end.tick) +
                     crash::activity("handles")
               : std::string("stopped immediately by a second signal"));
  wire::ServerMessage message;
  message.mutable_goodbye()->set_message(kShuttingDown);
  m_endpoint->network().broadcastAndClose(message.SerializeAsString(), kDrainTime);
  m_controls->reportForcedExit(kDrainTime);
  log.waitUntilLogged(kDrainTime);
  LineLog::waitUntilWritten(kDrainTime);
  if (!end.hung) endBySignal(end.signal);
  _exit(kExitHung);
}

void Host::beginGame(df::World& world) {
  m_p_world = &world;
  crash::setWorld(world);
  applySettings(world);
  m_clients->admission().setWorld(world);
  m_clients->rooms().open(world);
  m_empty_since = Clock::now();
}

void Host::endGame(df::World& world) {
  m_clients->rooms().clear();
  world.input().setGameOverLeaves(false);
  crash::clearWorld(world);
  m_p_world = nullptr;
}

// Applies the game's settings, unless an option overrides them.
void Host::applySettings(df::World& world) {
  HostOptions& options = m_context->options;
  if (const df::WorldExtras* p_extras = world.findExtras()) {
    // 33 ms is not applied, because the published engine's 33 ms stand for 1/30 s.
    const int millis = std::min(p_extras->settings.frame_time, kMaxFrameTimeMillis);
    if (options.frame_micros == 0 && millis != df::FRAME_TIME_DEFAULT) options.frame_micros = millis * 1000;
  }
  world.input().setGameOverLeaves(options.on_game_over != "exit");
  if (world.compat())
    m_context->log("compat is on: using the published engine's rules where they differ from the book's");
}

// Runs a minimum number of handlers even after the deadline, because an overloaded server must still receive.
// After the deadline, does not run all that are ready, because one flooding client could stop the world.
void Host::serveUntil(Clock::time_point deadline) {
  asio::io_context& home = m_context->home;
  home.restart();
  const auto enough = Clock::now() + kMinService;
  for (int served = 0; home.poll_one() > 0; ++served) {
    if (served >= kMinHandlers && Clock::now() >= enough) break;
  }
  home.run_until(deadline);
  sweep();
}

bool Host::isResting() const {
  return m_clients->sessions().isEmpty() && m_clients->rooms().rest();
}

// Waits while no world ticks, for kRestTime or, if that is less, the interval of the bus's heartbeat, which
// ticks send. A connection ends the wait.
TickClock Host::rest() {
  const auto heartbeat = std::chrono::milliseconds(m_context->options.bus_interval_ms);
  const auto end = Clock::now() + std::min(kRestTime, heartbeat);
  do {
    m_context->home.restart();
  } while (m_context->home.run_one_until(end) > 0 && isResting());
  return TickClock(Clock::now(), TickLength::fromMicros(m_context->options.frame_micros));
}

bool Host::isDue(TickClock& schedule) {
  const Clock::time_point now = Clock::now();
  if (now < schedule.deadline()) return false;
  Counters& counters = m_context->counters;
  m_context->stages.beginTick(counters.ticks + 1, schedule.deadline(), now);
  counters.late_ticks += now - schedule.deadline() > kLate ? 1 : 0;
  counters.rebased_ticks += schedule.beginTick(now) ? 1 : 0;
  return true;
}

// One tick: input -> world (step, input events, update, draw) -> published models -> snapshots. A world
// process ends its tick later, and its results are flushed then.
void Host::tick(Watchdog& watchdog) {
  StageClock& stages = m_context->stages;
  m_tick_began = Clock::now();
  stages.enter(Stage::kReceive);
  m_endpoint->network().serve(m_tick_began + kMinService);  // datagrams since the last tick
  stages.enter(Stage::kSessions);
  ++m_context->counters.ticks;
  m_clients->update(Clock::now());
  m_controls->update(m_tick_began);
  tickWorlds(watchdog);
  stages.enter(Stage::kBroadcasts);
  m_clients->sendPlayers();
  flush();
  for (const auto& part : m_parts) part->tick(m_tick_began);
  stages.enter(Stage::kIdle);
  if (m_observer) m_observer(*m_p_world);
}

// Only this function runs the game's code, unless the game runs in other processes.
void Host::tickWorlds(Watchdog& watchdog) {
  const std::uint64_t number = m_p_world->picture().view().tick + 1;
  watchdog.beginTick(number);
  crash::setTick(number);
  m_clients->rooms().beginTicks();
  crash::setTick(0);
  watchdog.endTick();
}

// Passes everything to the network thread. After the last room's tick, this ends the host's tick.
void Host::flush() {
  const Stage before = m_context->stages.enter(Stage::kFlush);
  if (m_clients->rooms().isTicking()) {
    m_endpoint->network().flush();
  } else {
    m_endpoint->network().flushTick(m_tick_began);
    m_context->stages.endTick();
  }
  m_context->stages.enter(before);
}

void Host::sweep() {
  m_clients->sessions().sweep();
  if (m_clients->sessions().connectedCount() > 0) m_empty_since = Clock::now();
}

// ---- end --------------------------------------------------------------------------------------------------

bool Host::isDeserted(Clock::time_point now) const {
  const double exit_when_empty = m_context->options.exit_when_empty;
  if (exit_when_empty <= 0 || m_clients->sessions().connectedCount() > 0) return false;
  const double first =
      m_context->counters.joined + m_context->counters.returned > 0 ? 0 : kFirstPlayerSeconds;
  return now - m_empty_since > std::chrono::duration<double>(std::max(exit_when_empty, first));
}

bool Host::isOver() const {
  const int ticks = m_context->options.ticks;
  const bool counted_out = ticks > 0 && m_context->counters.ticks >= static_cast<std::uint64_t>(ticks);
  const ShutdownScheduler& scheduler = m_context->shutdown_scheduler;
  // A player whose connection broke may return, so they count as playing.
  const bool is_due =
      scheduler.plan() && scheduler.isDue(Clock::now(), m_clients->sessions().playingCount() == 0);
  return m_clients->rooms().isOver() || is_due || counted_out || isDeserted(Clock::now());
}

// If a round is handed over, players get no goodbye: they lose the connection as if the server were killed.
void Host::sendGoodbyes() {
  if (m_controls->handsOverRound()) return;
  const ShutdownScheduler& scheduler = m_context->shutdown_scheduler;
  std::string sentence = m_clients->rooms().lastSentence();
  if (sentence.empty() || scheduler.isRestart()) sentence = scheduler.sentence();
  if (sentence.empty()) sentence = "The game is over.";
  const auto again = scheduler.isRestart() ? ShutdownScheduler::kReconnectWindow : std::chrono::seconds(0);
  m_clients->sessions().forEach([&](Session& session) { session.sendGoodbye(sentence, again); });
}

void Host::drain() {
  NetworkThread& network = m_endpoint->network();
  RoomManager& rooms = m_clients->rooms();
  m_controls->beginDrain();
  for (const auto& part : m_parts) part->drain();
  network.closeListener();
  sendGoodbyes();
  rooms.closeWorlds();
  network.flush();
  const Clock::time_point end = Clock::now() + kDrainTime;
  const auto are_players_left = [this] {
    return !m_controls->handsOverRound() && !m_clients->sessions().isEmpty();
  };
  while ((are_players_left() || !rooms.isEmpty()) && Clock::now() < end) {
    m_context->home.restart();
    m_context->home.run_one_until(rooms.isEmpty() ? end : std::min(end, Clock::now() + kDrainStep));
    sweep();
    rooms.closeWorlds();
  }
  network.stop();
  for (const auto& part : m_parts) part->finish();
  m_context->client_log.finish();
  logEnd();
}

void Host::logEnd() const {
  m_context->log("stopped: " + m_context->counters.summary());
  const auto log = [this](const std::string& what, const auto& counters) {
    const std::string text = listCounters(samplesOf(counters));
    if (!text.empty()) m_context->log(what + ": " + text);
  };
  const NetworkCounters network = m_endpoint->network().latestCounters();
  log("passwords", m_clients->admission().passwordCounters());
  log("streams", network.streams);
  log("visitors' socket", network.visitors);
  log("between the threads", network.relay);
  log("datagrams", network.gate);
}

void Host::stop(const std::string& sentence) {
  asio::post(m_context->home,
             [this, sentence] { m_controls->end({.at = Clock::time_point(), .sentence = sentence}); });
}

void Host::post(std::function<void(df::World&)> job) {
  asio::post(m_context->home, [this, job = std::move(job)] { job(*m_p_world); });
}

}  // namespace naiad
