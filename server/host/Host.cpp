#include "Host.h"

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/post.hpp>
#include <stdexcept>

#include "LookAlikes.h"
#include "Names.h"
#include "OpenFiles.h"
#include "Player.h"
#include "SafeText.h"
#include "StopSignals.h"
#include "TickClock.h"
#include "Version.h"
#include "World.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kLate{5};
constexpr std::chrono::milliseconds kLeastService{5};  ///< for sockets, however late the tick is
constexpr int kLeastHandlers = 16;                     ///< of theirs, ditto; one may serve many messages
constexpr std::chrono::seconds kDrainTime{1};
/// Sessions whose memory is fetched before their turn.
constexpr std::size_t kAhead = 1;
constexpr std::chrono::seconds kLonely{60};  ///< --exit-when-empty, if nobody ever came

/// How to seal datagrams for `channel`, if there is one.
void describe(const SealedChannel* channel, wire::Welcome& welcome) {
  if (channel == nullptr) return;
  welcome.set_connection_id(channel->id());
  welcome.set_aead(static_cast<std::uint32_t>(channel->aead()));
  welcome.set_epoch(channel->epoch());
}

/// The colours players get, in turn; black would not be seen.
constexpr df::Color kPlayerColors[] = {df::CYAN, df::GREEN, df::MAGENTA, df::YELLOW,
                                       df::RED,  df::BLUE,  df::WHITE};

df::Color colorOf(std::uint64_t nth) {
  return kPlayerColors[nth % std::size(kPlayerColors)];
}

/// Those who play, those who come back on another stream, and some who knock.
std::size_t mostConnections(const HostOptions& options) {
  return static_cast<std::size_t>(options.max_players) * 2 + 16;
}
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
  if (const std::size_t files = allowOpenFiles(mostConnections(m_options) + kOtherFiles);
      files < mostConnections(m_options) + kOtherFiles) {
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
  const StopSignals signals;
  TickClock schedule(Clock::now(), TickLength::fromMicros(m_options.frame_micros));
  m_empty_since = Clock::now();
  const auto work = asio::make_work_guard(m_io);  // or waiting for a deadline would end at once
  m_network.start();
  while (!isOver(world)) {
    serve();
    m_io.run_until(schedule.deadline());
    sweep();
    if (signals.isAsked()) m_stop_sentence = "The server is shutting down.";
    const Clock::time_point now = Clock::now();
    if (now < schedule.deadline()) continue;
    m_counters.late_ticks += now - schedule.deadline() > kLate ? 1 : 0;
    m_counters.rebased_ticks += schedule.begin(now) ? 1 : 0;
    tick(world);
  }
  m_round_over = wantsNextRound(world);
  drain();
  world.setHindsight(nullptr);
  world.setGameOverLeaves(false);
  m_p_world = nullptr;
}

// Also when the deadline has passed already: an overloaded server must not turn deaf, so there is a least
// number of handlers whatever the clock says. Not until nothing is ready any more, though: one client that
// floods would stop the world.
void Host::serve() {
  m_io.restart();
  const auto enough = Clock::now() + kLeastService;
  for (int served = 0; m_io.poll_one() > 0; ++served) {
    if (served >= kLeastHandlers && Clock::now() >= enough) break;
  }
}

// One tick: input -> world (step, input events, update, draw) -> published models -> snapshots.
void Host::tick(df::World& world) {
  const Clock::time_point began = Clock::now();
  m_network.serve(began + kLeastService);  // the datagrams since the last one
  const bool watched = playing() > 0;
  if (watched && !world.isWatched()) m_publisher = Publisher();
  world.setWatched(watched);
  const Clock::time_point heard = Clock::now();
  for (const auto& session : m_sessions) {
    session->checkDeadlines(heard);
    if (session->takeProof()) m_tokens.confirm(session->id());
  }

  giveTurn();
  applyInputs(world);
  world.tick();
  ++m_counters.ticks;
  dismissLeavers(world);
  if (watched) {
    m_publisher.update(world.view());
    lookBack(world);
    sendSnapshots(world);
    sendPlayers(world);
    sendSounds(world);
    sendNotes(world);
  }
  m_network.flushTick(began);
  if (m_observer) m_observer(world);
}

void Host::applyInputs(df::World& world) {
  const std::uint32_t next = world.view().tick + 1;
  forEachPlaying([this, &world, next](Session& session) {
    session.takeInputs(next, [&](const Input& input) {
      if (!isHeard(session, input)) return;
      if (input.is_mouse) {
        world.mouse(session.player(), static_cast<df::EventMouseAction>(input.action),
                    static_cast<df::Mouse::Button>(int{input.button} - 1), input.x, input.y,
                    session.seenWith(input));
      } else {
        world.key(session.player(), static_cast<df::Keyboard::Key>(input.key),
                  static_cast<df::EventKeyboardAction>(input.action));
      }
    });
  });
}

// Only a game that asked for it pays for the memory.
void Host::lookBack(df::World& world) {
  if (world.isLookingBack() != m_look_back.has_value()) {
    world.isLookingBack() ? static_cast<void>(m_look_back.emplace()) : m_look_back.reset();
    world.setHindsight(m_look_back ? &*m_look_back : nullptr);
  }
  if (m_look_back) m_look_back->note(m_publisher);
}

void Host::sendSnapshots(df::World& world) {
  const std::vector<df::PlayerFacts>& players = world.view().players;
  m_by_player.clear();
  forEachPlaying([&](Session& session) { m_by_player.push_back(&session); });
  const auto by_player = [](const Session* a, const Session* b) { return a->player() < b->player(); };
  if (!std::is_sorted(m_by_player.begin(), m_by_player.end(), by_player)) {
    std::sort(m_by_player.begin(), m_by_player.end(), by_player);
  }
  auto found = players.begin();
  for (std::size_t i = 0; i < m_by_player.size(); ++i) {
    if (i + 2 * kAhead < m_by_player.size()) m_by_player[i + 2 * kAhead]->prefetch();
    if (i + kAhead < m_by_player.size()) m_by_player[i + kAhead]->prefetchParts();
    Session& session = *m_by_player[i];
    while (found != players.end() && found->id < session.player()) ++found;  // both are in order
    if (found == players.end() || found->id != session.player()) continue;   // joins with the next tick
    // The truth first: whoever compares must find it once the snapshot has arrived.
    if (m_truth) writeTruth(*found, world);
    session.setControls(found->steering.p_table);
    session.sendTick(m_publisher, *found);
  }
}

void Host::writeTruth(const df::PlayerFacts& player, const df::World& world) {
  m_truth->write(m_publisher.tick(), player.id, world.renderPlayer(player.id));
  if (m_truth->isGood()) return;
  m_log("the truth file " + m_options.truth_file + " cannot be written any more; it ends here");
  m_truth.reset();
}

// Of those that this tick was sent to.
Session* Host::findTicking(std::uint32_t player) const {
  const auto found =
      std::lower_bound(m_by_player.begin(), m_by_player.end(), player,
                       [](const Session* session, std::uint32_t id) { return session->player() < id; });
  return found != m_by_player.end() && (*found)->player() == player ? *found : nullptr;
}

void Host::sendPlayers(const df::World& world) {
  m_player_news.tick(
      m_publisher.tick(), world.view().players,
      [&](std::uint32_t player) {
        const Session* session = findTicking(player);
        return session != nullptr ? session->rttMillis() : 0;
      },
      [&](std::uint32_t player, const wire::ServerMessage& message) {
        if (Session* session = findTicking(player)) session->sendKept(message, true);
      });
}

void Host::sendSounds(const df::World& world) {
  m_sound_news.tick(world.view(),
                    [this](std::uint32_t player, const wire::ServerMessage& message, bool lasts) {
                      Session* session = findTicking(player);
                      if (session == nullptr) return false;
                      if (!lasts) return session->sendFleeting(message);
                      session->sendKept(message);
                      return true;
                    });
  m_counters.sounds = m_sound_news.told();
  m_counters.sounds_dropped = m_sound_news.dropped();
}

void Host::accept(std::unique_ptr<ReliableChannel> channel) {
  ++m_counters.connections;
  // Half-open connections count too: they must not be a way round the limit. The oldest that plays no part
  // makes room, so that a crowd of silent connections does not lock out players, who greet at once. This is
  // the listener's callback, none of a session's, so sessions may go.
  const std::size_t most = mostConnections(m_options);
  if (m_sessions.size() >= most) sweep();
  if (m_sessions.size() >= most) {
    ++m_counters.turned_away;
    const auto idle = std::find_if(m_sessions.begin(), m_sessions.end(), [](const auto& session) {
      return session->state() != Session::State::kPlaying;
    });
    if (idle == m_sessions.end()) return;
    m_sessions.erase(idle);
  }
  m_sessions.push_back(std::make_unique<Session>(std::move(channel), m_counters, Clock::now()));
  m_sessions.back()->setId(m_next_session++);
  m_sessions.back()->start({[this](Session& session, const wire::Hello& hello) { greet(session, hello); },
                            [this](Session& session, const std::string& text) { chat(session, text); },
                            [this](Session& session) { leave(session); },
                            [this] { return m_network.now(); }});
}

// A session may go on with another stream at once; a new player may have to prove that he knows the password.
void Host::greet(Session& session, const wire::Hello& hello) {
  if (!checkHello(session, hello) || (!hello.resume_token().empty() && resume(session, hello))) return;
  if (m_password) return checkPassword(session, hello);
  admit(session, hello);
}

bool Host::checkHello(Session& session, const wire::Hello& hello) {
  if (hello.protocol() != kProtocolVersion) {
    ++m_counters.refused_version;
    const bool older = hello.protocol() < kProtocolVersion;
    session.refuse(wire::Refused::VERSION, "This server speaks version " + std::to_string(kProtocolVersion) +
                                               " of the protocol, your client version " +
                                               std::to_string(hello.protocol()) + ". Please update the " +
                                               (older ? "client." : "server."));
    return false;
  }
  if (!hello.game().empty() && hello.game() != m_game) {
    ++m_counters.refused_game;
    session.refuse(wire::Refused::GAME,
                   "This server plays \"" + m_game + "\", not \"" + cleanName(hello.game()) + "\".");
    return false;
  }
  return true;
}

void Host::checkPassword(Session& session, const wire::Hello& hello) {
  const auto judge = [this, id = session.id(), hello](PasswordCheck::Answer answer) {
    Session* waiting = find(id);
    if (waiting == nullptr || waiting->state() != Session::State::kGreeting) return;
    switch (answer) {
      case PasswordCheck::Answer::kRight:
        return admit(*waiting, hello);
      case PasswordCheck::Answer::kWrong:
        ++m_counters.refused_password;
        return waiting->refuse(wire::Refused::PASSWORD, hello.password().empty()
                                                            ? "This server wants a password."
                                                            : "That is not this server's password.");
      case PasswordCheck::Answer::kTooMany:
        ++m_counters.refused_password;
        return waiting->refuse(wire::Refused::PASSWORD, "Too many wrong passwords. Try again in a minute.");
      case PasswordCheck::Answer::kBusy:
        return waiting->refuse(wire::Refused::BUSY, "The server is busy. Try again in a moment.");
    }
  };
  const auto prefix = AddressPrefix::ofEndpoint(session.address()).value_or(AddressPrefix());
  m_password->check(prefix, hello.password(), Clock::now(), judge);
}

// Does the hello name a session that may go on? Then it does, on this stream.
bool Host::resume(Session& session, const wire::Hello& hello) {
  if (m_tokens.isElsewhere(hello.resume_token())) {
    ++m_counters.refused_elsewhere;
    session.refuse(wire::Refused::ELSEWHERE, "You went on playing in another terminal.");
    return true;
  }
  const auto id = m_tokens.redeem(hello.resume_token());
  Session* before = id ? find(*id) : nullptr;
  if (before == nullptr || before->state() != Session::State::kPlaying) {
    ++m_counters.unknown_tokens;
    return false;
  }
  wire::Welcome welcome = before->welcomed();
  welcome.set_resumed(true);
  welcome.set_tick(m_publisher.tick());
  welcome.set_resume_token(m_tokens.issue(before->id()));
  welcome.set_aead(0);
  if (hello.fresh()) {
    m_tokens.noteRestart(before->id());
    auto datagrams = openDatagrams(session, hello);
    describe(datagrams.get(), welcome);
    before->restart(session, welcome, std::move(datagrams));
    m_player_news.repeat();  // he has none
    m_sound_news.repeat(before->player());
    m_log(before->name() + " is back from " + before->address() + ", with another client");
    return true;
  }
  if (SealedChannel* datagrams = before->datagrams()) {
    const Epoch epoch = datagrams->epoch() + 1;
    welcome.set_connection_id(datagrams->id());
    if (datagrams->renew(*session.stream(), epoch)) describe(datagrams, welcome);
  }
  before->adopt(session, welcome, hello.received());
  m_log(before->name() + " is back from " + before->address());
  return true;
}

void Host::admit(Session& session, const wire::Hello& hello) {
  if (playing() >= static_cast<std::size_t>(m_options.max_players)) {
    ++m_counters.refused_full;
    session.refuse(wire::Refused::FULL, "The server is full (" + std::to_string(m_options.max_players) +
                                            " players). Try again later.");
    return;
  }
  if (fromSameAddress(session) >= static_cast<std::size_t>(m_options.max_per_address)) {
    ++m_counters.refused_address;
    session.refuse(wire::Refused::FULL, "There are " + std::to_string(m_options.max_per_address) +
                                            " players from your address already. Try again later.");
    return;
  }
  const std::string wanted = cleanName(hello.player_name());
  if (wanted.empty()) {
    ++m_counters.refused_name;
    session.refuse(wire::Refused::NAME, "A player needs a name of 1 to 16 printable characters.");
    return;
  }
  std::vector<std::string> taken;
  forEachPlaying([&](const Session& other) { taken.push_back(other.name()); });
  const std::string name = uniqueName(wanted, taken);

  const df::Color color = colorOf(m_counters.joined++);
  wire::Welcome welcome;
  welcome.set_player(m_p_world->join(name, color));
  welcome.set_name(name);
  welcome.set_game(m_game);
  welcome.set_tick_micros(static_cast<std::uint32_t>(TickLength::fromMicros(m_options.frame_micros).times(1) /
                                                     std::chrono::microseconds(1)));
  welcome.set_view_width(static_cast<std::uint32_t>(m_p_world->getWindowWidth()));
  welcome.set_view_height(static_cast<std::uint32_t>(m_p_world->getWindowHeight()));
  welcome.set_color(static_cast<std::uint32_t>(color));
  welcome.set_tick(m_publisher.tick());
  welcome.set_server(safeText(m_options.name, kMaxProgramLength - 20) + " (dfserver " + kVersion + ")");
  for (const std::string& line : m_p_world->getHelp()) {
    if (welcome.help_size() < static_cast<int>(kMaxHelpLines)) {
      welcome.add_help(safeText(line, kMaxHelpLength));
    }
  }
  std::unique_ptr<SealedChannel> datagrams = openDatagrams(session, hello);
  describe(datagrams.get(), welcome);
  const auto grace =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(m_options.grace));
  session.setGrace(grace);
  welcome.set_grace_millis(static_cast<std::uint32_t>(grace.count()));
  if (m_options.grace > 0) welcome.set_resume_token(m_tokens.issue(session.id()));
  session.welcome(welcome, std::move(datagrams));
  tellTurn(session);
  m_player_news.repeat();
  m_ever_joined = true;
  m_log(name + " joined from " + session.address() + " with " + safeText(hello.program(), kMaxProgramLength));
}

// The first cipher of the client's list that there is.
std::unique_ptr<SealedChannel> Host::openDatagrams(const Session& session, const wire::Hello& hello) {
  for (const std::uint32_t wanted : hello.aeads()) {
    if (const auto aead = aeadFromWire(wanted)) return m_network.openDatagrams(*session.stream(), *aead);
  }
  return nullptr;
}

Session* Host::find(std::uint64_t id) {
  const auto found =
      std::lower_bound(m_sessions.begin(), m_sessions.end(), id,
                       [](const auto& session, std::uint64_t wanted) { return session->id() < wanted; });
  return found != m_sessions.end() && (*found)->id() == id ? found->get() : nullptr;
}

void Host::chat(const Session& session, const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_player(session.player());
  message.mutable_chat()->set_text(text);
  forEachPlaying([&](Session& other) { other.sendKept(message); });
}

void Host::leave(Session& session) {
  m_tokens.forget(session.id());
  if (session.player() == 0) return;
  if (m_p_world != nullptr) m_p_world->leave(session.player());
  m_log(session.name() + " left");
}

// Players' sessions are destroyed here and nowhere else: their callbacks run inside them. To be called from
// outside of those.
void Host::sweep() {
  std::erase_if(m_sessions, [](const auto& session) { return session->state() == Session::State::kGone; });
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

bool Host::isOver(const df::World& world) const {
  const bool counted_out =
      m_options.ticks > 0 && m_counters.ticks >= static_cast<std::uint64_t>(m_options.ticks);
  return world.isGameOver() || !m_stop_sentence.empty() || counted_out || isDeserted(Clock::now());
}

void Host::drain() {
  m_network.closeListener();
  const std::string sentence = m_stop_sentence.empty() ? "The game is over." : m_stop_sentence;
  if (m_round_over) {
    m_log("the round is over");
    m_sessions.clear();
  }
  for (const auto& session : m_sessions) session->goodbye(sentence);
  m_network.flush();
  const Clock::time_point end = Clock::now() + kDrainTime;
  while (!m_sessions.empty() && Clock::now() < end) {
    m_io.restart();
    m_io.run_one_until(end);
    sweep();
  }
  m_network.stop();
  m_log("stopped: " + m_counters.summary());
  logRefusals();
}

// What came to the door and was not let in.
void Host::logRefusals() const {
  const TcpListener::Counters& streams = m_network.streamCounters();
  std::string text = listCounters({{"failed_accepts", streams.failed_accepts},
                                   {"handshakes_failed", streams.handshakes_failed},
                                   {"handshakes_late", streams.handshakes_late},
                                   {"refused_half_open", streams.refused_half_open},
                                   {"refused_from_prefix", streams.refused_from_prefix}});
  if (!text.empty()) m_log("streams: " + text);
  const RelayCounters relay = m_network.counters();
  text = listCounters({{"datagrams_in_dropped", relay.datagrams_in_dropped},
                       {"datagrams_out_dropped", relay.datagrams_out_dropped},
                       {"streams_overflowed", relay.streams_overflowed},
                       {"streams_clogged", relay.streams_clogged},
                       {"unmet", relay.unmet},
                       {"keyless", relay.keyless}});
  if (!text.empty()) m_log("between the threads: " + text);
  if (!m_network.hasDatagrams()) return;
  const DatagramGateCounters gate = m_network.gateCounters();
  text = listCounters({{"delivered", gate.delivered},
                       {"too_short", gate.too_short},
                       {"too_long", gate.too_long},
                       {"bad_kind", gate.bad_kind},
                       {"unknown_id", gate.unknown_id},
                       {"session_flood", gate.session_flood},
                       {"claimed_flood", gate.claimed_flood},
                       {"prefix_flood", gate.prefix_flood},
                       {"stranger_flood", gate.stranger_flood},
                       {"refused", gate.refused}});
  if (!text.empty()) m_log("datagrams: " + text);
}

void Host::stop(const std::string& sentence) {
  asio::post(m_io, [this, sentence] { m_stop_sentence = sentence; });
}

void Host::post(std::function<void(df::World&)> job) {
  asio::post(m_io, [this, job = std::move(job)] { job(*m_p_world); });
}

}  // namespace naiad
