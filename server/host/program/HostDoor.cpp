// How players come in: what they are asked, why they are sent away, and how those who were here go on.
#include <algorithm>

#include "engine/world/World.h"
#include "host/program/Host.h"
#include "host/program/TickClock.h"
#include "host/session/Names.h"
#include "shared/net/base/SafeText.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

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

}  // namespace

// Those who play, those who come back on another stream, and some who knock.
std::size_t Host::mostConnections() const {
  return mostPlayers() * 2 + 16;
}

void Host::accept(std::unique_ptr<ReliableChannel> channel) {
  ++m_counters.connections;
  // Half-open connections count too: they must not be a way round the limit. The oldest that plays no part
  // makes room, so that a crowd of silent connections does not lock out players, who greet at once. This is
  // the listener's callback, none of a session's, so sessions may go.
  const std::size_t most = mostConnections();
  if (m_sessions.size() >= most) sweep();
  if (m_sessions.size() >= most) {
    ++m_counters.turned_away;
    const auto idle = std::find_if(m_sessions.begin(), m_sessions.end(), [](const auto& session) {
      return session->state() != Session::State::kPlaying;
    });
    if (idle == m_sessions.end()) return;
    if (Room* p_room = roomOf(**idle)) p_room->remove(**idle);
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
  if (!checkHello(session, hello)) return;
  if (hello.second_stream()) return accompany(session, hello);
  if (!hello.resume_token().empty() && resume(session, hello)) return;
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
  if (const Room* p_room = roomOf(*before)) welcome.set_tick(p_room->tick());
  welcome.set_resume_token(m_tokens.issue(before->id()));
  welcome.set_aead(0);
  if (hello.fresh()) {
    m_tokens.noteRestart(before->id());
    auto datagrams = openDatagrams(session, hello);
    describe(datagrams.get(), welcome);
    before->restart(session, welcome, std::move(datagrams));
    m_player_news.repeat();  // he has none
    if (Room* p_room = roomOf(*before)) p_room->repeatSounds(before->player());
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

// Whoever shows the token of a session that has its stream may open a second one beside that. He is no new
// player if he may not.
void Host::accompany(Session& session, const wire::Hello& hello) {
  const auto id = m_tokens.holderOf(hello.resume_token());
  Session* first = id ? find(*id) : nullptr;
  if (first == nullptr || first->state() != Session::State::kPlaying || first->isDetached()) {
    ++m_counters.unknown_tokens;
    return session.refuse(wire::Refused::BAD_REQUEST, "There is no stream for this one to go beside.");
  }
  m_log(first->name() + " has a second stream, from " + session.address());
  first->accompany(session);
}

void Host::admit(Session& session, const wire::Hello& hello) {
  if (!hasPlaceFor(session)) return;
  const std::string wanted = cleanName(hello.player_name());
  if (wanted.empty()) {
    ++m_counters.refused_name;
    session.refuse(wire::Refused::NAME, "A player needs a name of 1 to 16 printable characters.");
    return;
  }
  Room* p_room = roomForNewcomer();
  if (p_room == nullptr) {
    session.refuse(wire::Refused::BUSY, "The server cannot begin another world. Try again later.");
    return;
  }
  std::vector<std::string> taken;
  forEachPlaying([&](const Session& other) { taken.push_back(other.name()); });
  const std::string name = uniqueName(wanted, taken);
  wire::Welcome welcome = welcomeTo(*p_room, name);
  std::unique_ptr<SealedChannel> datagrams = openDatagrams(session, hello);
  describe(datagrams.get(), welcome);
  const auto grace =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::duration<double>(m_options.grace));
  session.setGrace(grace);
  welcome.set_grace_millis(static_cast<std::uint32_t>(grace.count()));
  if (m_options.grace > 0) {
    welcome.set_resume_token(m_tokens.issue(session.id()));
    welcome.set_second_stream(true);
  }
  session.welcome(welcome, std::move(datagrams));
  p_room->add(session);
  m_player_news.repeat();
  m_ever_joined = true;
  m_log(name + " joined from " + session.address() + " with " + safeText(hello.program(), kMaxProgramLength));
}

// If not, it was refused.
bool Host::hasPlaceFor(Session& session) {
  if (playing() >= mostPlayers()) {
    ++m_counters.refused_full;
    session.refuse(wire::Refused::FULL, "The server is full (" + std::to_string(m_options.max_players) +
                                            " players). Try again later.");
    return false;
  }
  if (fromSameAddress(session) >= static_cast<std::size_t>(m_options.max_per_address)) {
    ++m_counters.refused_address;
    session.refuse(wire::Refused::FULL, "There are " + std::to_string(m_options.max_per_address) +
                                            " players from your address already. Try again later.");
    return false;
  }
  return true;
}

// A player of this name joins the room's world.
wire::Welcome Host::welcomeTo(Room& room, const std::string& name) {
  const df::Color color = colorOf(m_counters.joined++);
  const std::uint32_t player = room.join(m_next_player, name, color);
  m_next_player = player + 1;
  wire::Welcome welcome;
  welcome.set_player(player);
  welcome.set_name(name);
  welcome.set_game(m_game);
  welcome.set_tick_micros(static_cast<std::uint32_t>(TickLength::fromMicros(m_options.frame_micros).times(1) /
                                                     std::chrono::microseconds(1)));
  welcome.set_view_width(static_cast<std::uint32_t>(m_p_world->getWindowWidth()));
  welcome.set_view_height(static_cast<std::uint32_t>(m_p_world->getWindowHeight()));
  welcome.set_color(static_cast<std::uint32_t>(color));
  welcome.set_tick(room.tick());
  welcome.set_server(safeText(m_options.name, kMaxProgramLength - 20) + " (dfserver " + kVersion + ")");
  for (const std::string& line : m_p_world->getHelp()) {
    if (welcome.help_size() < static_cast<int>(kMaxHelpLines)) {
      welcome.add_help(safeText(line, kMaxHelpLength));
    }
  }
  return welcome;
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
  if (Room* p_room = roomOf(session)) {
    // His own world ends with him.
    isPrivate() ? p_room->port().close() : p_room->port().leave(session.player());
  }
  m_log(session.name() + " left");
}

}  // namespace naiad
