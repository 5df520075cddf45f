#include "host/ops/ChatCommands.h"

#include <algorithm>
#include <utility>

#include "host/loop/HostClients.h"
#include "host/ops/AdminConsole.h"
#include "host/rooms/SessionTable.h"
#include "shared/admin/AdminAnswer.h"
#include "shared/net/base/AddressPrefix.h"
#include "shared/program/LogText.h"

namespace naiad {

namespace {

using Level = AdminCommand::Level;
using Frontend = AdminCommand::Frontend;

constexpr std::string_view kAdminCommand = "/admin ";

Level levelOf(const Session& session) {
  return session.status().isAdmin() ? Level::kAdmin : Level::kPlayer;
}

}  // namespace

ChatCommands::ChatCommands(const HostAccess& access, HostAdmin& admin, AdminConsole& console, BanList& bans)
    : m_access(access), m_admin(admin), m_console(console), m_bans(bans) {
  const std::string& password = access.context.options.admin_password;
  if (!password.empty())
    m_password =
        std::make_unique<PasswordCheck>(access.context.home.get_executor(), PasswordHash::fromText(password));
}

void ChatCommands::logClientEvent(const Session& session, const std::string& text) {
  m_access.context.client_log.logClientEvent(session.address(), text, session.now());
}

void ChatCommands::refuse(Session& session, const std::string& sentence) {
  m_access.context.client_log.logRefusal(session.address(), sentence, session.now());
}

// The line "/admin PASSWORD" is not split into words, because a password may have quotes and blanks.
void ChatCommands::serve(Session& session, const std::string& whole) {
  const std::string line = whole.substr(whole.find('/'));
  if (line.starts_with(kAdminCommand)) return becomeAdmin(session, line.substr(kAdminCommand.size()));
  try {
    execute(session, readAdminRequest(splitAdminLine(std::string_view(line).substr(1))));
  } catch (const AdminUsageError& error) {
    reply(session, {error.what(), "/help lists the commands."});
  }
}

void ChatCommands::execute(Session& session, const AdminRequest& request) {
  const AdminCommand& command = *request.command;
  if (!command.isFor(levelOf(session), Frontend::kChat))
    return reply(session, {"You may not use the command \"" + command.name + "\" here."});
  if (command.name == "help" || command.name == "commands") return help(session, request);
  if (command.name == "admin") return becomeAdmin(session, request.of("password"));
  if (command.name == "vote") return vote(session, request);
  AdminCaller caller;
  caller.level = levelOf(session);
  caller.name = "player " + inQuotes(session.name()) + " at " + session.address();
  caller.player = session.name();
  caller.session = session.id();
  m_console.execute(request, caller, [this, id = session.id()](const AdminAnswer& answer) {
    if (Session* p_session = m_access.clients.sessions().find(id)) reply(*p_session, answerText(answer));
  });
}

void ChatCommands::help(Session& session, const AdminRequest& request) {
  const AdminCommand* const p_command = findAdminCommand(request.of("command"));
  if (!request.has("command")) return reply(session, adminHelp(levelOf(session), Frontend::kChat));
  if (p_command == nullptr || !p_command->isFor(levelOf(session), Frontend::kChat))
    return reply(session, {"Unknown command \"" + request.of("command") + "\", or you may not use it."});
  reply(session, adminHelp(*p_command));
}

void ChatCommands::reply(Session& session, const std::vector<std::string>& lines) {
  const std::size_t shown = lines.size() > kMaxLines ? kMaxLines - 1 : lines.size();
  for (std::size_t i = 0; i < shown; ++i) sendServerLine(session, lines[i]);
  if (shown < lines.size())
    sendServerLine(session, "… and " + std::to_string(lines.size() - shown) + " more lines.");
}

// ---- admins -----------------------------------------------------------------------------------------------

void ChatCommands::becomeAdmin(Session& session, const std::string& password) {
  if (!m_password) return reply(session, {"This server does not allow admins in the chat."});
  const auto prefix = AddressPrefix::ofEndpoint(session.address()).value_or(AddressPrefix());
  m_password->check(prefix, true, password, session.now(),
                    [this, id = session.id(), streams = session.status().streams()](auto answer) {
                      onPassword(id, streams, answer);
                    });
}

// Admin rights belong to a stream. The session may have been resumed on another stream since the check began.
void ChatCommands::onPassword(std::uint64_t id, std::uint32_t streams, PasswordCheck::Answer answer) {
  Session* const p_session = m_access.clients.sessions().find(id);
  if (p_session == nullptr || p_session->state() != Session::State::kPlaying) return;
  const std::string who = inQuotes(p_session->name());
  switch (answer) {
    case PasswordCheck::Answer::kRight:
      if (p_session->status().streams() != streams || p_session->isDetached()) return;
      p_session->status().setAdmin();
      logClientEvent(*p_session, who + " is an admin now");
      return reply(*p_session, {"You are an admin until your connection ends."});
    case PasswordCheck::Answer::kWrong:
      refuse(*p_session, "That is not the admin password.");
      return reply(*p_session, {"That is not the admin password."});
    case PasswordCheck::Answer::kTooMany:
      refuse(*p_session, "Too many wrong admin passwords.");
      return reply(*p_session, {"Too many wrong passwords. Try again in a minute."});
    case PasswordCheck::Answer::kBusy:
      return reply(*p_session, {"The server is busy. Try again in a moment."});
    case PasswordCheck::Answer::kNoMemory:
      return reply(*p_session, {"The server has too little memory to check a password."});
  }
}

// ---- votes ------------------------------------------------------------------------------------------------

void ChatCommands::vote(Session& session, const AdminRequest& request) {
  if (!m_access.context.options.vote_kick) return reply(session, {"This server does not allow votes."});
  const std::vector<AdminPlayer> players = m_admin.players();
  const PlayerLookup choice = resolvePlayer(players, request.of("player"));
  if (!choice.player) return reply(session, answerText(choice.problem));
  const std::string& name = choice.player->name;
  const auto outcome = m_vote.vote(players, session.id(), choice.player->session, session.now());
  const std::string voices =
      " (" + std::to_string(m_vote.votes()) + " of " + std::to_string(m_vote.needed()) + " votes)";
  switch (outcome) {
    case VoteKick::Outcome::kBegun:
      logClientEvent(session, inQuotes(session.name()) + " starts a vote to kick " + inQuotes(name));
      return m_admin.broadcast(session.name() + " starts a vote to kick " + name + ". /vote kick " + name +
                               " agrees within 30 seconds" + voices + ".");
    case VoteKick::Outcome::kAgreed:
      return m_admin.broadcast(session.name() + " agrees to vote " + name + " out" + voices + ".");
    case VoteKick::Outcome::kPassed:
      return kickByVote(*choice.player);
    case VoteKick::Outcome::kAlready:
      return reply(session, {"You have already agreed."});
    case VoteKick::Outcome::kOther:
      return reply(session, {"A vote on another player is running. Wait until it is over."});
    case VoteKick::Outcome::kTooSoon:
      return reply(session, {"You started a vote recently. Try again in two minutes."});
    case VoteKick::Outcome::kSelf:
      return reply(session, {"You cannot vote on a player at your own address."});
  }
}

// Bans the name, and the address unless it is this machine's or others play there. The ban is short, so it
// is not written to disk.
void ChatCommands::kickByVote(const AdminPlayer& player) {
  if (const Session* const p_session = m_access.clients.sessions().find(player.session))
    logClientEvent(*p_session, inQuotes(player.name) + " is kicked by a vote");
  m_admin.broadcast("The players have voted to kick " + player.name + " for five minutes.");
  Ban ban;
  ban.name = player.name;
  ban.reason = "the players voted to kick you";
  ban.by = "a vote";
  ban.made = m_bans.time();
  ban.until = ban.made + VoteKick::kBanTime;
  ban.persistent = false;
  std::vector<Ban> bans{ban};
  const std::vector<AdminPlayer> players = m_admin.players();
  const auto prefix = AddressPrefix::ofEndpoint(player.address);
  const bool alone = std::none_of(players.begin(), players.end(), [&](const AdminPlayer& other) {
    return other.session != player.session && AddressPrefix::ofEndpoint(other.address) == prefix;
  });
  const auto address = endpointAddress(player.address);
  if (alone && address && !address->is_loopback()) {
    ban.kind = Ban::Kind::kRange;
    ban.range = AddressRange::around(*address);
    bans.push_back(ban);
  }
  m_bans.add(bans, [](const std::string&) {});
  m_admin.kickPlayer(player.session, banMessage(ban));
}

void ChatCommands::update(Session::Clock::time_point now) {
  if (m_vote.popFailed(now)) m_admin.broadcast("The vote is over: too few agreed.");
}

}  // namespace naiad
