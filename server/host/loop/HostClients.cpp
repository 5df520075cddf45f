#include "host/loop/HostClients.h"

#include <utility>

#include "host/admission/CapacityLimits.h"
#include "host/rooms/SessionTable.h"
#include "host/session/NameSanitizer.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/program/LogText.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

/// True if this chat line, cleaned by cleanChat(), is a command. Ignores leading blanks and question marks:
/// clients send undrawable characters as question marks, and a command's password must not reach others.
bool isCommand(const std::string& line) {
  const std::size_t first = line.find_first_not_of(" ?");
  return first != std::string::npos && line[first] == '/';
}

}  // namespace

HostClients::HostClients(HostContext& context, HostEndpoint& endpoint, std::function<void()> on_late_tick)
    : m_context(context),
      m_endpoint(endpoint),
      m_sessions(maxConnections(context.options), context.counters,
                 [this](Session& session) { m_rooms.removeSession(session); }),
      m_rooms(context, m_sessions, std::move(on_late_tick)),
      m_admission({context, m_sessions, m_rooms, m_player_list, endpoint.prefixes(),
                   [&endpoint](const auto& stream, AeadId aead) {
                     return endpoint.network().openDatagrams(stream, aead);
                   },
                   [this](const wire::Welcome& welcome) -> Session& {
                     Session& session = m_sessions.addDetached(Clock::now());
                     session.restore(welcome, sessionEvents());
                     return session;
                   }}),
      m_room_transfers(context, m_sessions, m_rooms, m_admission),
      m_chat(RateLimits::chat(context.options.max_per_address)) {
  m_rooms.setOnRound([this](const Room& room) { m_admission.recordSessions(room); },
                     [this](Room& room, const std::vector<PersistedSession>& sessions) {
                       m_admission.restoreSessions(room, sessions);
                     });
  m_rooms.setOnTransfer(
      [this](Session& session, const std::string& room) { m_room_transfers.askByGame(session, room); });
  m_rooms.setOnRoomClosed(
      [this](const Room& room, const std::string& sentence) { m_room_transfers.evacuate(room, sentence); });
  nameSkeletons({});  // loads the tables now, not in the tick of the first join
  applyCapacityLimits();
}

ServerInfo HostClients::facts() const {
  const HostOptions& options = m_context.options;
  return {.name = options.name,
          .game = m_context.game,
          .protocol = kProtocolVersion,
          .players = static_cast<std::uint32_t>(m_sessions.playingCount()),
          .max_players = static_cast<std::uint32_t>(options.max_players),
          .requires_password = !options.password.empty()};
}

void HostClients::add(std::unique_ptr<ReliableChannel> channel) {
  m_sessions.add(std::move(channel), sessionEvents(), Clock::now());
}

void HostClients::applyCapacityLimits() {
  m_sessions.setMaxSessions(maxConnections(m_context.options));
  const std::size_t wanted = requiredOpenFiles(m_context.options);
  if (const std::size_t files = raiseOpenFileLimit(wanted); files < wanted) {
    m_context.log(LogEvent::warning(
        "the limit of open files is " + std::to_string(files) + " (ulimit -Hn): too few for " +
        std::to_string(m_context.options.max_players) + " players and their reconnects"));
  }
}

void HostClients::update(Clock::time_point now) {
  const std::chrono::seconds idle_limit(m_context.options.inactive_kick);
  m_sessions.forEach([&](Session& session) {
    session.checkDeadlines(now);
    if (session.popWelcomeConfirmed()) m_admission.confirmToken(session);
    m_inactivity.check(session, idle_limit, m_context.counters, sendServerLine);
  });
  m_context.client_log.update(now);
  m_rooms.checkWorlds();
  m_admission.evaluateWaiting();
  m_room_transfers.update();
}

void HostClients::sendPlayers() {
  if (m_sessions.playingCount() == 0) return;
  m_player_list.tick(
      static_cast<std::uint32_t>(m_context.counters.ticks), m_rooms.players(),
      [this](std::uint32_t player) {
        const Session* p_session = m_rooms.findPlayer(player);
        return p_session != nullptr ? p_session->rttMillis() : 0;
      },
      [this](std::uint32_t player, const wire::ServerMessage& message) {
        if (Session* p_session = m_rooms.findPlayer(player)) p_session->sendReliable(message);
      });
}

void HostClients::broadcast(const std::string& text) {
  m_sessions.forEachPlaying([&text](Session& session) { sendServerLine(session, text); });
}

Session::Events HostClients::sessionEvents() {
  return {[this](Session& session, const wire::Hello& hello) { m_admission.evaluateHello(session, hello); },
          [this](Session& session, const std::string& text) { handleChat(session, text); },
          [this](Session& session) { endSession(session); },
          [this] { return m_endpoint.network().now(); },
          [this](Session& session, const std::string& sentence) {
            m_context.client_log.logRefusal(session.address(), sentence, session.now());
          },
          [this](Session& session) { m_room_transfers.sendList(session); },
          [this](Session& session, const std::string& room) { m_room_transfers.ask(session, room); }};
}

// Commands go only to the server, even if they fail.
void HostClients::handleChat(Session& session, const std::string& text) {
  const auto prefix = AddressPrefix::ofEndpoint(session.address()).value_or(AddressPrefix());
  if (!m_chat.tryConsume(prefix, session.now())) {
    ++m_context.counters.chat_dropped;
  } else if (isCommand(text)) {
    m_serve_command ? m_serve_command(session, text)
                    : sendServerLine(session, "This server has no commands.");
  } else if (session.status().isMuted()) {
    ++m_context.counters.chat_muted;
    sendServerLine(session, "You are muted: other players do not see your lines.");
  } else {
    sendChat(session, text);
  }
}

void HostClients::sendChat(const Session& session, const std::string& text) {
  m_context.feed.publish("chat", inQuotes(session.name()) + ": " + text);
  if (m_context.options.log_chat) {
    m_context.client_log.logClientEvent(session.address(),
                                        {"chat",
                                         inQuotes(session.name()) + " says " + inQuotes(text),
                                         {{"player", session.name()}, {"line", text}}},
                                        session.now());
  }
  wire::ServerMessage message;
  message.mutable_chat()->set_player(session.player());
  message.mutable_chat()->set_text(text);
  m_sessions.forEachPlaying([&](Session& other) { other.sendReliable(message); });
}

void HostClients::endSession(Session& session) {
  m_admission.forgetSession(session);
  m_inactivity.forget(session);
  if (session.player() == 0) return;
  m_rooms.leave(session);
  m_context.client_log.logClientEvent(session.address(),
                                      {"left",
                                       inQuotes(session.name()) + " left: " + session.leaveReason(),
                                       {{"player", session.name()}, {"reason", session.leaveReason()}}},
                                      session.now());
}

}  // namespace naiad
