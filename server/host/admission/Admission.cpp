#include "host/admission/Admission.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "engine/world/Views.h"
#include "host/process/TickClock.h"
#include "host/session/NameSanitizer.h"
#include "naiad.pb.h"
#include "shared/net/base/AddressRange.h"
#include "shared/net/base/SafeText.h"
#include "shared/program/LogText.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

/// Describes how to seal datagrams for `channel`, which may be null.
void describe(const SealedChannel* channel, wire::Welcome& welcome) {
  if (channel == nullptr) return;
  welcome.set_connection_id(channel->id());
  welcome.set_aead(static_cast<std::uint32_t>(channel->aead()));
  welcome.set_epoch(channel->epoch());
}

/// Colours of players, in turn. Blue is dark on a black background, so it is last; black is invisible.
constexpr df::Color kPlayerColors[] = {df::CYAN, df::GREEN, df::MAGENTA, df::YELLOW,
                                       df::RED,  df::WHITE, df::BLUE};

AddressPrefix prefixOf(const Session& session) {
  return AddressPrefix::ofEndpoint(session.address()).value_or(AddressPrefix());
}

std::string versionSentence(std::uint32_t version) {
  return "This server speaks version " + std::to_string(kProtocolVersion) +
         " of the protocol, your client version " + std::to_string(version) + ". Please update the " +
         (version < kProtocolVersion ? "client." : "server.");
}

PersistedSession keptOf(const wire::Welcome& welcome, const ResumeTokens::Hashed& tokens, bool muted) {
  return {.player = welcome.player(),
          .muted = muted,
          .name = welcome.name(),
          .color = static_cast<df::Color>(welcome.color()),
          .newest = tokens.newest,
          .redeemed = tokens.redeemed};
}

/// Returns the log line `"NAME" HAPPENED`, with the name among its fields.
LogEvent newsOf(const char* what, const std::string& name, const std::string& happened,
                LogEvent::Fields facts = {}) {
  facts.insert(facts.begin(), {"player", name});
  return {what, inQuotes(name) + " " + happened, std::move(facts)};
}

}  // namespace

Admission::Admission(Setup setup)
    : m_setup(std::move(setup)),
      m_options(m_setup.context.options),
      m_counters(m_setup.context.counters),
      m_joins(RateLimits::joins(m_options.max_per_address)),
      m_new_worlds(RateLimits::worlds(m_options.max_per_address, m_options.max_players)),
      m_room_admission(m_setup.rooms, m_setup.sessions, m_options.max_per_address) {
  const std::string& password = m_options.password;
  if (!password.empty()) changePassword(PasswordHash::fromText(password));
}

void Admission::log(const Session& session, LogEvent event) const {
  m_setup.context.client_log.logClientEvent(session.address(), std::move(event), session.now());
}

// Waiting guesses are compared with the new hash, or with the old one if no password is needed any more.
void Admission::changePassword(std::optional<PasswordHash> hash) {
  m_needs_password = hash.has_value();
  if (!hash) return;
  if (m_password) return m_password->setHash(std::move(*hash));
  m_password = std::make_unique<PasswordCheck>(m_setup.context.home.get_executor(), std::move(*hash));
}

void Admission::evaluateHello(Session& session, const wire::Hello& hello) {
  if (!checkHello(session, hello) || isBanned(session, cleanName(hello.player_name()))) return;
  if (waitsForRound(hello)) {
    m_waiting.push_back({session.id(), std::make_shared<wire::Hello>(hello), session.now()});
    return;
  }
  if (hello.second_stream()) return addSecondStream(session, hello);
  if (!hello.resume_token().empty() && resumeSession(session, hello)) return;
  if (m_needs_password) return checkPassword(session, hello);
  admitPlayer(session, hello);
}

// While a round is in recovery, all hellos wait. With named rooms only hellos with an unknown resume token
// wait, because their session may be in a room in recovery; such a room refuses new players
// (RoomAdmission.h).
bool Admission::waitsForRound(const wire::Hello& hello) const {
  if (!m_setup.rooms.recovering()) return false;
  return !m_setup.rooms.isNamed() ||
         (!hello.resume_token().empty() && !m_tokens.find(hello.resume_token()).has_value());
}

// The address was checked before TLS, but a ban may have been added since then.
bool Admission::isBanned(Session& session, const std::string& name) {
  const auto address = endpointAddress(session.address());
  const std::string sentence =
      m_find_ban ? m_find_ban(address.value_or(asio::ip::address()), name) : std::string();
  if (sentence.empty()) return false;
  ++m_counters.refused_banned;
  session.refuse(wire::Refused::BAD_REQUEST, safeText(sentence, kMaxMessageLength));
  return true;
}

bool Admission::checkHello(Session& session, const wire::Hello& hello) {
  if (hello.protocol() != kProtocolVersion) {
    ++m_counters.refused_version;
    session.refuse(wire::Refused::VERSION, versionSentence(hello.protocol()));
    return false;
  }
  if (!hello.game().empty() && hello.game() != m_setup.context.game && !m_setup.rooms.isNamed()) {
    ++m_counters.refused_game;
    session.refuse(wire::Refused::GAME, "This server plays \"" + m_setup.context.game + "\", not \"" +
                                            cleanName(hello.game()) + "\".");
    return false;
  }
  if (!hello.room().empty() && !m_setup.rooms.isNamed()) {
    ++m_counters.refused_room;
    session.refuse(wire::Refused::GAME, "This server has no rooms. Join without a room name.");
    return false;
  }
  return true;
}

// ---- password ---------------------------------------------------------------------------------------------

void Admission::checkPassword(Session& session, const wire::Hello& hello) {
  const auto on_answer = [this, id = session.id(), hello](PasswordCheck::Answer answer) {
    Session* p_waiting = m_setup.sessions.find(id);
    if (p_waiting == nullptr || p_waiting->state() != Session::State::kGreeting) return;
    applyPasswordAnswer(*p_waiting, hello, answer);
  };
  const AddressPrefix prefix = prefixOf(session);
  m_password->check(prefix, m_setup.prefixes.count(prefix) > 0, hello.password(), Session::Clock::now(),
                    on_answer);
}

void Admission::applyPasswordAnswer(Session& session, const wire::Hello& hello,
                                    PasswordCheck::Answer answer) {
  switch (answer) {
    case PasswordCheck::Answer::kRight:
      return admitPlayer(session, hello);
    case PasswordCheck::Answer::kWrong:
      ++m_counters.refused_password;
      return session.refuse(wire::Refused::PASSWORD, hello.password().empty()
                                                         ? "This server requires a password."
                                                         : "That is not this server's password.");
    case PasswordCheck::Answer::kTooMany:
      ++m_counters.refused_password;
      return session.refuse(wire::Refused::PASSWORD, "Too many wrong passwords. Try again in a minute.");
    case PasswordCheck::Answer::kBusy:
      return refuseBusy(session, "The server is busy. Try again in a moment.");
    case PasswordCheck::Answer::kNoMemory:
      ++m_counters.refused_full;
      return session.refuse(
          wire::Refused::FULL,
          "The server has too little memory to check a password. Its host can raise the limit "
          "of its address space (ulimit -v).");
  }
}

PasswordCheck::Counters Admission::passwordCounters() const {
  return m_password ? m_password->counters() : PasswordCheck::Counters();
}

void Admission::forgetSession(const Session& session) {
  if (Room* p_room = m_setup.rooms.roomOf(session); p_room != nullptr && session.player() != 0)
    p_room->round().recordSession({.player = session.player(), .over = true});
  m_tokens.forget(session.id());
  m_setup.prefixes.forget(session.id());
}

// ---- resumed sessions -------------------------------------------------------------------------------------

// Returns false if the token belongs to no session that can be resumed.
bool Admission::resumeSession(Session& session, const wire::Hello& hello) {
  if (m_tokens.isSuperseded(hello.resume_token())) {
    ++m_counters.refused_session_moved;
    session.refuse(wire::Refused::SESSION_MOVED, "This session was resumed in another client.");
    return true;
  }
  const auto id = m_tokens.find(hello.resume_token());
  Session* p_before = id ? m_setup.sessions.find(*id) : nullptr;
  if (p_before == nullptr || p_before->state() != Session::State::kPlaying) {
    ++m_counters.unknown_tokens;
    return false;
  }
  if (isBanned(session, p_before->name())) return true;
  if (!p_before->admitResume()) {  // the token stays valid for the next attempt
    session.refuse(wire::Refused::BUSY, "Too many reconnects. Try again in a moment.");
    return true;
  }
  m_tokens.redeem(hello.resume_token());
  if (p_before->isRestored()) {
    replaceRestoredSession(*p_before, session, hello);
    return true;
  }
  wire::Welcome welcome = p_before->welcomed();
  welcome.set_resumed(true);
  if (const Room* p_room = m_setup.rooms.roomOf(*p_before)) welcome.set_tick(p_room->tick());
  welcome.set_resume_token(m_tokens.issue(p_before->id()));
  welcome.set_aead(0);
  recordSession(*p_before);
  m_setup.prefixes.record(p_before->id(), prefixOf(session));
  hello.new_process() ? restartSession(*p_before, session, hello, welcome)
                      : continueSession(*p_before, session, hello, welcome);
  return true;
}

void Admission::restartSession(Session& before, Session& session, const wire::Hello& hello,
                               wire::Welcome& welcome) {
  m_tokens.markSuperseded(before.id());
  auto datagrams = openDatagrams(session, hello);
  describe(datagrams.get(), welcome);
  before.restart(session, welcome, std::move(datagrams));
  m_setup.player_list.repeat();
  if (Room* p_room = m_setup.rooms.roomOf(before)) p_room->repeatSounds(before.player());
  log(before, newsOf("restarted", before.name(), "reconnected with a new client"));
}

void Admission::continueSession(Session& before, Session& session, const wire::Hello& hello,
                                wire::Welcome& welcome) {
  if (SealedChannel* p_datagrams = before.datagrams()) {
    const Epoch epoch = p_datagrams->epoch() + 1;
    welcome.set_connection_id(p_datagrams->id());
    if (p_datagrams->renew(*session.stream(), epoch)) describe(p_datagrams, welcome);
  }
  before.resumeOn(session, welcome, hello.last_frame());
  log(before, newsOf("resumed", before.name(), "reconnected"));
}

// Adds a second stream to a session that has its first one. If there is no such session, refuses the client:
// it is not a new player, because it asked for a second stream.
void Admission::addSecondStream(Session& session, const wire::Hello& hello) {
  const auto id = m_tokens.findNewest(hello.resume_token());
  Session* p_first = id ? m_setup.sessions.find(*id) : nullptr;
  if (p_first == nullptr || p_first->state() != Session::State::kPlaying || p_first->isDetached()) {
    ++m_counters.unknown_tokens;
    return session.refuse(wire::Refused::BAD_REQUEST, "The session of this second stream is not connected.");
  }
  if (isBanned(session, p_first->name())) return;
  if (!p_first->admitSecondStream()) {  // the token and the existing streams stay valid
    return session.refuse(wire::Refused::BUSY,
                          "Too many reconnects of the second stream. Try again in a moment.");
  }
  log(session, newsOf("second_stream", p_first->name(), "opened a second stream"));
  p_first->attachSecondStream(session);
}

// ---- sessions of a killed server --------------------------------------------------------------------------

// Refuses hellos that have waited too long. Reconnecting clients retry after a moment and show the sentence.
void Admission::evaluateWaiting() {
  const int percent = m_setup.rooms.recovering().value_or(100);
  const std::chrono::milliseconds patience = percent > 50 ? kNearEndWait : kRecoveryWait;
  for (const WaitingHello& one : std::exchange(m_waiting, {})) {
    Session* p_session = m_setup.sessions.find(one.session);
    if (p_session == nullptr || p_session->state() != Session::State::kGreeting) continue;
    if (!waitsForRound(*one.hello)) {
      evaluateHello(*p_session, *one.hello);
    } else if (p_session->now() - one.since < patience) {
      m_waiting.push_back(one);
    } else {
      refuseBusy(*p_session, "Restoring your game after a restart: " + std::to_string(percent) + " %.");
    }
  }
}

void Admission::restoreSessions(Room& room, const std::vector<PersistedSession>& sessions) {
  if (!m_setup.restore_session) return;
  for (const PersistedSession& kept : sessions) {
    Session& session = m_setup.restore_session(welcomeOf(room, kept.player, kept.name, kept.color));
    session.setGrace(graceTime());
    session.status().setMuted(kept.muted);
    m_tokens.restore(session.id(), {kept.newest, kept.redeemed});
    m_setup.rooms.add(room, session);
    ++m_counters.restored;
  }
}

// The client continues with the session of its new stream. Neither the client nor this session has any state,
// so the world is sent from the beginning. The welcome may be lost, so the previous token stays valid until
// the client has read it.
void Admission::replaceRestoredSession(Session& before, Session& session, const wire::Hello& hello) {
  Room* p_room = m_setup.rooms.roomOf(before);
  wire::Welcome welcome = before.welcomed();
  if (p_room != nullptr) welcome.set_tick(p_room->tick());
  welcome.clear_resumed();
  welcome.clear_resume_state();
  std::unique_ptr<SealedChannel> datagrams = openDatagrams(session, hello);
  welcome.clear_connection_id();
  welcome.clear_aead();
  welcome.clear_epoch();
  describe(datagrams.get(), welcome);
  m_tokens.move(before.id(), session.id());
  welcome.set_resume_token(m_tokens.issue(session.id()));
  m_setup.prefixes.forget(before.id());
  m_setup.prefixes.record(session.id(), prefixOf(session));
  if (p_room != nullptr)
    p_room->round().recordSession(keptOf(welcome, m_tokens.hashed(session.id()), before.status().isMuted()));
  session.setGrace(graceTime());
  session.welcome(welcome, std::move(datagrams));
  session.replaceRestored(before);
  if (p_room != nullptr) {
    p_room->remove(before);
    m_setup.rooms.add(*p_room, session);
  }
  m_setup.player_list.repeat();
  ++m_counters.returned;
  log(session, newsOf("resumed", session.name(), "reconnected to the recovered round"));
}

void Admission::confirmToken(Session& session) {
  session.confirm();
  m_tokens.confirm(session.id());
  recordSession(session);
}

void Admission::recordSession(const Session& session) const {
  Room* p_room = m_setup.rooms.roomOf(session);
  if (p_room != nullptr) p_room->round().recordSession(persistedSession(session));
}

void Admission::recordSessions(const Room& room) const {
  room.forEachPlaying([this](const Session& session) { recordSession(session); });
}

PersistedSession Admission::persistedSession(const Session& session) const {
  return keptOf(session.welcomed(), m_tokens.hashed(session.id()), session.status().isMuted());
}

// ---- new players ------------------------------------------------------------------------------------------

// Calls `visit(name, color)` for all players, including those that rounds in recovery wait for.
template <class Visit>
void Admission::forEachPlayer(Visit visit) const {
  m_setup.sessions.forEachPlaying([&visit](const Session& session) {
    visit(session.name(), static_cast<df::Color>(session.welcomed().color()));
  });
  m_setup.rooms.forEachRoom([&visit](const Room& room) {
    for (const PersistedSession& one : room.round().awaitedSessions()) visit(one.name, one.color);
  });
}

void Admission::admitPlayer(Session& session, const wire::Hello& hello) {
  if (!checkLimits(session)) return;
  const std::string wanted = cleanName(hello.player_name());
  if (wanted.empty()) {
    ++m_counters.refused_name;
    return session.refuse(wire::Refused::NAME, "Invalid player name: expected 1 to 16 printable characters.");
  }
  Room* p_room = roomFor(session, hello);
  if (p_room == nullptr) return;
  const std::string name = freeName(wanted);
  wire::Welcome welcome = welcomeTo(*p_room, name);
  std::unique_ptr<SealedChannel> datagrams = openDatagrams(session, hello);
  describe(datagrams.get(), welcome);
  session.setGrace(graceTime());
  if (m_options.grace > 0) welcome.set_resume_token(m_tokens.issue(session.id()));
  m_setup.prefixes.record(session.id(), prefixOf(session));
  p_room->round().recordSession(keptOf(welcome, m_tokens.hashed(session.id()), false));
  session.welcome(welcome, std::move(datagrams));
  m_setup.rooms.add(*p_room, session);
  m_setup.player_list.repeat();
  const std::string program = safeText(hello.program(), kMaxProgramLength);
  log(session, newsOf("joined", name, "joined with " + inQuotes(program), {{"program", program}}));
}

// Returns false if the session was refused.
bool Admission::checkLimits(Session& session) {
  if (!m_setup.context.shutdown_scheduler.acceptsPlayers()) {
    ++m_counters.refused_closing;
    refuseFull(session, "The server is shutting down and accepts no new players.");
    return false;
  }
  const int max_players = m_options.max_players;
  const int max_per_address = m_options.max_per_address;
  const auto places = static_cast<std::size_t>(max_players);
  std::size_t players = 0;
  forEachPlayer([&players](const std::string&, df::Color) { ++players; });
  const std::size_t awaited = players - m_setup.sessions.playingCount();
  if (players >= places &&
      !m_setup.sessions.makePlace(prefixOf(session), places - std::min(awaited, places), session.now())) {
    ++m_counters.refused_full;
    refuseFull(session, "The server is full (" + std::to_string(max_players) + " players). Try again later.");
    return false;
  }
  // Also counts players without a connection. Otherwise one address could collect the places kept for them.
  if (m_setup.prefixes.count(prefixOf(session)) >= static_cast<std::size_t>(max_per_address)) {
    ++m_counters.refused_address;
    session.refuse(wire::Refused::FULL, "Too many players from your address (limit " +
                                            std::to_string(max_per_address) + "). Try again later.");
    return false;
  }
  return true;
}

// Refuses a session because there is no free place or the server stops. Adds a link to a server with places,
// if one is known.
void Admission::refuseFull(Session& session, const std::string& sentence) {
  const auto link = m_find_redirect ? m_find_redirect() : std::nullopt;
  if (!link) return session.refuse(wire::Refused::FULL, sentence);
  ++m_counters.redirected;
  const std::string said =
      safeText(sentence + " Another server has free places: " + link->text(), kMaxMessageLength);
  session.refuse(wire::Refused::FULL, said, JoinLink{link->address, "", link->key}.text(), link->room);
}

// Returns null if the session is refused. Limits joins per address, because rejoining resets other limits.
Room* Admission::roomFor(Session& session, const wire::Hello& hello) {
  const AddressPrefix prefix = prefixOf(session);
  const Session::Clock::time_point now = session.now();
  if (!m_joins.tryConsume(prefix, now)) {
    refuseBusy(session, "Too many players have joined from your address. Try again in a moment.");
    return nullptr;
  }
  if (m_setup.rooms.isNamed()) return namedRoomFor(session, hello);
  if (m_setup.rooms.isPrivate() && !m_new_worlds.tryConsume(prefix, now)) {
    refuseBusy(session, "Too many games started recently. Try again in a moment.");
    return nullptr;
  }
  std::string problem;
  Room* p_room = m_setup.rooms.roomForNewPlayer(problem);
  if (p_room != nullptr) return p_room;
  if (!problem.empty()) log(session, {LogEvent::Level::kError, "cannot join: " + problem});
  refuseBusy(session, "The server cannot start another game. Try again later.");
  return nullptr;
}

Room* Admission::namedRoomFor(Session& session, const wire::Hello& hello) {
  RoomAdmission::Refusal refusal;
  Room* p_room = m_room_admission.findRoom(hello.room(), hello.game(), refusal);
  if (p_room == nullptr) {
    refuseRoom(session, refusal);
  } else if (const auto closed = m_room_admission.open(*p_room, prefixOf(session), session.now())) {
    refuseRoom(session, *closed);
    p_room = nullptr;
  }
  return p_room;
}

void Admission::refuseRoom(Session& session, const RoomAdmission::Refusal& refusal) {
  if (!refusal.log.empty()) log(session, {LogEvent::Level::kError, "cannot join: " + refusal.log});
  switch (refusal.reason) {
    case RoomAdmission::Reason::kUnknown:
      ++m_counters.refused_room;
      return session.refuse(wire::Refused::GAME, safeText(refusal.sentence, kMaxMessageLength));
    case RoomAdmission::Reason::kGame:
      ++m_counters.refused_game;
      return session.refuse(wire::Refused::GAME, refusal.sentence);
    case RoomAdmission::Reason::kFull:
      ++m_counters.refused_full;
      return session.refuse(wire::Refused::FULL, refusal.sentence);
    case RoomAdmission::Reason::kTemporary:
      return refuseBusy(session, refusal.sentence);
  }
}

// The player gets a new id in the new room, because a world uses an id only once.
std::string Admission::moveSession(Session& session, const std::string& room, bool led) {
  if (!m_setup.rooms.isNamed()) return "This server has no rooms.";
  if (room.empty()) return "Room name missing.";
  if (session.isDetached() && !led) return "Your connection is broken.";
  if (!session.supportsRooms()) return "Your client is too old to change rooms: join with HOST/" + room + ".";
  RoomAdmission::Refusal refusal;
  Room* const p_to = m_room_admission.findRoom(room, "", refusal);
  if (p_to == nullptr) return safeText(refusal.sentence, kMaxChatLength);
  const AddressPrefix prefix = prefixOf(session);
  if (!led && !m_room_admission.tryMove(prefix, session.now()))
    return "Too many room changes. Try again in a moment.";
  if (const auto closed = m_room_admission.open(*p_to, prefix, session.now())) return closed->sentence;
  if (Room* const p_from = m_setup.rooms.roomOf(session))
    p_from->round().recordSession({.player = session.player(), .over = true});
  m_setup.rooms.leaveRoom(session);
  const auto color = static_cast<df::Color>(session.welcomed().color());
  wire::Welcome welcome = session.welcomed();
  const std::uint32_t player = newPlayerId();
  p_to->join(player, session.name(), color);
  welcome.set_player(player);
  describeRoom(*p_to, welcome);
  session.enterRoom(welcome);
  m_setup.rooms.add(*p_to, session);
  recordSession(session);
  return {};
}

void Admission::refuseBusy(Session& session, const std::string& sentence) {
  ++m_counters.refused_busy;
  session.refuse(wire::Refused::BUSY, sentence);
}

std::string Admission::freeName(const std::string& wanted) const {
  std::vector<std::string> taken;
  forEachPlayer([&taken](const std::string& name, df::Color) { taken.push_back(name); });
  return uniqueName(wanted, taken);
}

// Returns one of the colors that the fewest players have. If several qualify, ids take turns.
df::Color Admission::freeColor(std::uint32_t player) const {
  std::map<df::Color, int> uses;
  forEachPlayer([&uses](const std::string&, df::Color color) { ++uses[color]; });
  const auto nth = [player](std::size_t i) {
    return kPlayerColors[(player - 1 + i) % std::size(kPlayerColors)];
  };
  df::Color best = nth(0);
  for (std::size_t i = 1; i < std::size(kPlayerColors); ++i) {
    if (uses[nth(i)] < uses[best]) best = nth(i);
  }
  return best;
}

// Returns an id above all that the worlds have used: a world gives a new player no lower one.
std::uint32_t Admission::newPlayerId() {
  m_setup.rooms.forEachRoom([this](const Room& room) {
    m_newest_player = std::max(m_newest_player, room.round().highestPlayer());
  });
  return ++m_newest_player;
}

// Adds a player of this name to the room's world, and returns their welcome.
wire::Welcome Admission::welcomeTo(Room& room, const std::string& name) {
  const std::uint32_t player = newPlayerId();
  const df::Color color = freeColor(player);
  ++m_counters.joined;
  room.join(player, name, color);
  return welcomeOf(room, player, name, color);
}

std::chrono::milliseconds Admission::graceTime() const {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::duration<double>(m_options.grace));
}

// Sets the fields that depend on the room and its game.
void Admission::describeRoom(const Room& room, wire::Welcome& welcome) const {
  const RoomConfig* const p_plan = room.plan();
  welcome.set_tick(room.tick());
  welcome.set_game(p_plan != nullptr ? p_plan->game : m_setup.context.game);
  welcome.set_room(p_plan != nullptr ? p_plan->name : "");
  const int width = p_plan != nullptr ? p_plan->ready.window_width : m_p_world->views().width();
  const int height = p_plan != nullptr ? p_plan->ready.window_height : m_p_world->views().height();
  welcome.set_view_width(static_cast<std::uint32_t>(width));
  welcome.set_view_height(static_cast<std::uint32_t>(height));
  welcome.clear_help();
  for (const std::string& line : p_plan != nullptr ? p_plan->ready.help : m_p_world->getHelp()) {
    if (welcome.help_size() < static_cast<int>(kMaxHelpLines)) {
      welcome.add_help(safeText(line, kMaxHelpLength));
    }
  }
}

wire::Welcome Admission::welcomeOf(const Room& room, std::uint32_t player, const std::string& name,
                                   df::Color color) const {
  const TickLength tick = TickLength::fromMicros(m_options.frame_micros);
  wire::Welcome welcome;
  welcome.set_player(player);
  welcome.set_name(name);
  welcome.set_tick_micros(static_cast<std::uint32_t>(tick.times(1) / std::chrono::microseconds(1)));
  describeRoom(room, welcome);
  welcome.set_color(static_cast<std::uint32_t>(color));
  welcome.set_grace_millis(static_cast<std::uint32_t>(graceTime().count()));
  welcome.set_second_stream(m_options.grace > 0);
  welcome.set_server(safeText(m_options.name, kMaxProgramLength - 20) + " (dfserver " + kVersion + ")");
  return welcome;
}

// Opens datagrams with the first cipher of the client's list that the server supports.
std::unique_ptr<SealedChannel> Admission::openDatagrams(const Session& session,
                                                        const wire::Hello& hello) const {
  for (const std::uint32_t wanted : hello.aeads()) {
    if (const auto aead = aeadFromWire(wanted)) return m_setup.open_datagrams(*session.stream(), *aead);
  }
  return nullptr;
}

}  // namespace naiad
