#include "host/program/Host.h"

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>
#include <stdexcept>

#include "engine/managers/GameManager.h"
#include "engine/world/Player.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "host/program/OpenFiles.h"
#include "host/program/StopSignals.h"
#include "host/program/TickClock.h"
#include "host/session/LookAlikes.h"
#include "host/world/WorldInProcess.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kLate{5};
constexpr std::chrono::milliseconds kMinService{5};  ///< for sockets, however late the tick is
constexpr int kMinHandlers = 16;                     ///< of theirs, ditto; one may serve many messages
constexpr std::chrono::seconds kDrainTime{1};
constexpr std::chrono::milliseconds kLookEvery{10};  ///< while the last ones go
constexpr std::chrono::seconds kLonely{60};          ///< --exit-when-empty, if nobody ever came
constexpr int kLongestFrameMillis = 1000;            ///< as --frame-time

/// Beside connections: half-open ones, libraries, logs.
constexpr std::size_t kOtherFiles = 512;

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

}  // namespace

Host::Host(HostOptions options, std::string game, Log log)
    : m_options(std::move(options)),
      m_game(std::move(game)),
      m_log(std::move(log)),
      m_identity(identityOf(m_options)),
      m_network(
          m_io, m_options.address, static_cast<std::uint16_t>(m_options.port),
          [this](std::unique_ptr<ReliableChannel> channel) { accept(std::move(channel)); }, channelOptions(),
          m_identity ? TlsListening{m_identity->tls()} : TlsListening{}),
      m_empty_since(Clock::now()) {
  shapesOf({});  // loads the tables now: the tick of the first join should not wait for them
  if (!m_options.password.empty()) {
    m_password =
        std::make_unique<PasswordCheck>(m_io.get_executor(), PasswordHash::fromText(m_options.password));
  }
  const std::size_t wanted =
      mostConnections() + mostPlayers() + kOtherFiles;  // each may have a second stream
  if (const std::size_t files = allowOpenFiles(wanted); files < wanted) {
    m_log("only " + std::to_string(files) + " files may be open (ulimit -Hn): too few for " +
          std::to_string(m_options.max_players) + " players and those who come back");
  }
  if (m_options.truth_file.empty()) return;
  m_truth.emplace(m_options.truth_file);
  if (!m_truth->isGood())
    throw std::runtime_error("The truth file " + m_options.truth_file + " cannot be written.");
}

std::optional<Fingerprint> Host::fingerprint() const {
  return m_identity ? std::optional(m_identity->fingerprint()) : std::nullopt;
}

std::string Host::joinArguments() const {
  const std::string port = std::to_string(m_network.port());
  const bool any = m_options.address == "::" || m_options.address == "0.0.0.0";
  const std::string where = any ? "127.0.0.1:" + port : m_network.address();
  return where + (m_identity ? " --fingerprint " + m_identity->fingerprint().text() : " --insecure");
}

Host::~Host() = default;

// The server's loop: serve sockets until the next tick is due, then tick.
void Host::run(df::World& world) {
  m_p_world = &world;
  adoptSettings(world);
  if (!m_new_world) {
    openRoom(std::make_unique<WorldInProcess>(world));
  } else if (!isPrivate()) {
    openRoom(m_new_world(m_io));
  }
  const StopSignals signals;
  TickClock schedule(Clock::now(), TickLength::fromMicros(m_options.frame_micros));
  m_empty_since = Clock::now();
  const auto work = asio::make_work_guard(m_io);  // or waiting for a deadline would end at once
  m_network.start();
  while (!isOver()) {
    serve();
    m_io.run_until(schedule.deadline());
    sweep();
    if (signals.isAsked()) m_stop_sentence = "The server is shutting down.";
    const Clock::time_point now = Clock::now();
    if (now < schedule.deadline()) continue;
    m_counters.late_ticks += now - schedule.deadline() > kLate ? 1 : 0;
    m_counters.rebased_ticks += schedule.begin(now) ? 1 : 0;
    tick();
  }
  drain();
  m_rooms.clear();
  world.setGameOverLeaves(false);
  m_p_world = nullptr;
}

// What the game asks for, unless this host was told otherwise.
void Host::adoptSettings(df::World& world) {
  if (const df::WorldExtras* p_extras = world.findExtras()) {
    // 33 ms is how the published engine writes 1/30 s.
    const int millis = std::min(p_extras->settings.frame_time, kLongestFrameMillis);
    if (m_options.frame_micros == 0 && millis != df::FRAME_TIME_DEFAULT)
      m_options.frame_micros = millis * 1000;
  }
  world.setGameOverLeaves(m_options.on_game_over != "exit");
  if (world.compat()) m_log("compat is on: the published engine's rules where they differ from the book's");
}

// Also when the deadline has passed already: an overloaded server must not turn deaf, so there is a least
// number of handlers whatever the clock says. Not until nothing is ready any more, though: one client that
// floods would stop the world.
void Host::serve() {
  m_io.restart();
  const auto enough = Clock::now() + kMinService;
  for (int served = 0; m_io.poll_one() > 0; ++served) {
    if (served >= kMinHandlers && Clock::now() >= enough) break;
  }
}

// One tick: input -> world (step, input events, update, draw) -> published models -> snapshots. A world in a
// process of its own answers later; afterTick() comes then.
void Host::tick() {
  m_tick_began = Clock::now();
  m_network.serve(m_tick_began + kMinService);  // the datagrams since the last one
  const Clock::time_point heard = Clock::now();
  for (const auto& session : m_sessions) {
    session->checkDeadlines(heard);
    if (session->takeProof()) m_tokens.confirm(session->id());
  }
  ++m_counters.ticks;
  if (m_new_world) lookAfterWorlds();
  m_in_tick = true;
  for (const auto& room : m_rooms) {
    if (!room->beginTick(m_truth.has_value())) ++m_counters.late_worlds;
  }
  m_in_tick = false;
  sendPlayers();
  flush();
  if (m_observer) m_observer(*m_p_world);
}

void Host::afterTick(Room& room) {
  dismissLeavers(room);
  const std::uint64_t told = room.sounds().told();
  const std::uint64_t dropped = room.sounds().dropped();
  room.publish(m_truth ? &*m_truth : nullptr);
  m_counters.sounds += room.sounds().told() - told;
  m_counters.sounds_dropped += room.sounds().dropped() - dropped;
  if (m_truth && !m_truth->isGood()) {
    m_log("the truth file " + m_options.truth_file + " cannot be written any more; it ends here");
    m_truth.reset();
  }
  if (!m_in_tick) flush();
}

// The last room's ends the tick.
void Host::flush() {
  const bool ticking =
      std::any_of(m_rooms.begin(), m_rooms.end(), [](const auto& room) { return room->isTicking(); });
  ticking ? m_network.flush() : m_network.flushTick(m_tick_began);
}

// The game is over for those who pressed the key that ends it; the others play on.
void Host::dismissLeavers(Room& room) {
  for (const std::uint32_t leaver : room.port().takeLeavers()) {
    if (m_ends_with_last && connected() <= 1) {
      room.port().endGame();
      continue;
    }
    if (Session* session = room.find(leaver)) session->goodbye("For you, the game is over.");
  }
}

// Players of all rooms are one company.
void Host::sendPlayers() {
  if (playing() == 0) return;
  const bool several = m_rooms.size() > 1;
  if (several) {
    m_players.clear();
    for (const auto& room : m_rooms) {
      const auto& players = room->port().view().players;
      m_players.insert(m_players.end(), players.begin(), players.end());
    }
    std::sort(m_players.begin(), m_players.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  }
  const auto find_player = [this](std::uint32_t player) -> Session* {
    for (const auto& room : m_rooms) {
      if (Session* p_session = room->find(player)) return p_session;
    }
    return nullptr;
  };
  m_player_news.tick(
      tickNumber(), several ? m_players : m_rooms.front()->port().view().players,
      [&](std::uint32_t player) {
        const Session* session = find_player(player);
        return session != nullptr ? session->rttMillis() : 0;
      },
      [&](std::uint32_t player, const wire::ServerMessage& message) {
        if (Session* session = find_player(player)) session->sendKept(message, true);
      });
}

// Players' sessions are destroyed here and nowhere else: their callbacks run inside them. To be called from
// outside of those.
void Host::sweep() {
  std::erase_if(m_sessions, [this](const auto& session) {
    const bool gone = session->state() == Session::State::kGone;
    if (Room* p_room = gone ? roomOf(*session) : nullptr) p_room->remove(*session);
    return gone;
  });
  if (connected() > 0) m_empty_since = Clock::now();
}

std::size_t Host::playing() const {
  return static_cast<std::size_t>(
      std::count_if(m_sessions.begin(), m_sessions.end(),
                    [](const auto& session) { return session->state() == Session::State::kPlaying; }));
}

// Those that play and are there.
std::size_t Host::connected() const {
  return static_cast<std::size_t>(
      std::count_if(m_sessions.begin(), m_sessions.end(), [](const auto& session) {
        return session->state() == Session::State::kPlaying && !session->isDetached();
      }));
}

// Of those that play and are there: who has lost his place in the network must not keep it from others.
std::size_t Host::fromSameAddress(const Session& session) const {
  const auto prefix = AddressPrefix::ofEndpoint(session.address());
  return static_cast<std::size_t>(
      std::count_if(m_sessions.begin(), m_sessions.end(), [&prefix](const auto& other) {
        return other->state() == Session::State::kPlaying && !other->isDetached() &&
               AddressPrefix::ofEndpoint(other->address()) == prefix;
      }));
}

std::uint64_t Host::skippedTicks(std::uint32_t player) const {
  const auto found = std::find_if(m_sessions.begin(), m_sessions.end(),
                                  [player](const auto& session) { return session->player() == player; });
  return found != m_sessions.end() ? (*found)->skippedTicks() : 0;
}

bool Host::isDeserted(Clock::time_point now) const {
  if (m_options.exit_when_empty <= 0 || connected() > 0) return false;
  const std::chrono::duration<double> patience(m_options.exit_when_empty);
  return now - m_empty_since >
         (m_ever_joined ? patience : std::max<std::chrono::duration<double>>(patience, kLonely));
}

bool Host::isOver() const {
  const bool counted_out =
      m_options.ticks > 0 && m_counters.ticks >= static_cast<std::uint64_t>(m_options.ticks);
  const bool game_over = m_new_world ? m_worlds_over : m_p_world->isGameOver();
  return game_over || !m_stop_sentence.empty() || counted_out || isDeserted(Clock::now());
}

void Host::drain() {
  m_network.closeListener();
  const std::string sentence = m_stop_sentence.empty() ? "The game is over." : m_stop_sentence;
  for (const auto& session : m_sessions) session->goodbye(sentence);
  closeWorlds();
  m_network.flush();
  const Clock::time_point end = Clock::now() + kDrainTime;
  while ((!m_sessions.empty() || !m_rooms.empty()) && Clock::now() < end) {
    m_io.restart();
    m_io.run_one_until(m_rooms.empty() ? end : std::min(end, Clock::now() + kLookEvery));
    sweep();
    closeWorlds();
  }
  m_network.stop();
  m_log("stopped: " + m_counters.summary());
  logRefusals();
}

void Host::stop(const std::string& sentence) {
  asio::post(m_io, [this, sentence] { m_stop_sentence = sentence; });
}

void Host::post(std::function<void(df::World&)> job) {
  asio::post(m_io, [this, job = std::move(job)] { job(*m_p_world); });
}

}  // namespace naiad
