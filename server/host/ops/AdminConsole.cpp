#include "host/ops/AdminConsole.h"

#include <algorithm>
#include <asio/post.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "shared/net/base/AddressPrefix.h"
#include "shared/net/base/AddressRange.h"
#include "shared/net/base/SafeText.h"
#include "shared/options/Duration.h"
#include "shared/program/LogText.h"

namespace naiad {

namespace {

using Fits = std::function<bool(const AdminPlayer&)>;

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

std::optional<std::uint32_t> idOf(const std::string& typed) {
  return typed.starts_with('#') ? readNumber(typed.substr(1), 0u, UINT32_MAX) : std::nullopt;
}

std::vector<AdminPlayer> thoseThat(const std::vector<AdminPlayer>& players, const Fits& fits) {
  std::vector<AdminPlayer> found;
  std::copy_if(players.begin(), players.end(), std::back_inserter(found), fits);
  return found;
}

PlayerLookup oneOf(const std::vector<AdminPlayer>& found, const std::string& typed) {
  if (found.size() == 1) return {found.front()};
  AdminAnswer problem = AdminAnswer::refused("Several players match \"" + typed + "\":");
  for (const AdminPlayer& player : found)
    problem.candidates.push_back("#" + std::to_string(player.id) + " " + player.name);
  return {std::nullopt, std::move(problem)};
}

using Level = AdminCommand::Level;

constexpr std::size_t kScoresOfATable = 10;
constexpr std::size_t kMaxScoresOfATable = 10'000;
/// Shortest bannable prefixes, in bits. A wider range covers whole providers, so it is likely a typo.
constexpr int kMinBitsIPv4 = 8;
constexpr int kMinBitsIPv6 = 16;

const char* const kNameMark = "name:";

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string withReason(const std::string& sentence, const std::string& reason) {
  return sentence + (reason.empty() ? "." : ": " + reason);
}

AdminRow rowOf(const AdminPlayer& player, Level level) {
  AdminRow row{{"id", static_cast<std::int64_t>(player.id)},
               {"name", player.name},
               {"ping_ms", static_cast<std::int64_t>(player.rtt_millis)}};
  if (!player.room.empty()) row.emplace_back("room", player.room);
  if (level == Level::kPlayer) return row;
  row.emplace_back("address", player.address);
  row.emplace_back("played_s", static_cast<std::int64_t>(player.connected.count()));
  row.emplace_back("idle_s", static_cast<std::int64_t>(player.idle.count()));
  row.emplace_back("away", player.detached);
  row.emplace_back("muted", player.muted);
  row.emplace_back("admin", player.admin);
  return row;
}

/// The bans that a command makes, or the reason why it makes none.
struct BanPlan {
  std::vector<Ban> bans;
  std::string note;  ///< shown to the caller of the command
  AdminAnswer problem{};
};

BanPlan refusedPlan(AdminAnswer problem) {
  return {{}, "", std::move(problem)};
}

BanPlan planRange(Ban ban, const AddressRange& range) {
  if (range.bits() < (range.isIPv4() ? kMinBitsIPv4 : kMinBitsIPv6))
    return refusedPlan(AdminAnswer::refused(range.text() + " is too wide: expected at least /" +
                                            std::to_string(range.isIPv4() ? kMinBitsIPv4 : kMinBitsIPv6) +
                                            "."));
  const asio::ip::address first = unmapped(asio::ip::address_v6(range.bytes()));
  if (first.is_loopback() || range.contains(asio::ip::address_v6::loopback()))
    return refusedPlan(
        AdminAnswer::refused("Loopback addresses cannot be banned: all players on this machine have them."));
  ban.range = range;
  return {{std::move(ban)}, ""};
}

BanPlan planName(Ban ban, const std::string& name) {
  if (name.empty()) return refusedPlan(AdminAnswer::refused("Expected a name after \"name:\"."));
  ban.kind = Ban::Kind::kName;
  ban.name = name;
  return {{std::move(ban)}, ""};
}

// Plans a player's ban: only of the name if the address is this machine's, or is shared with other players.
BanPlan planPlayer(const Ban& ban, const std::vector<AdminPlayer>& players, const std::string& typed) {
  const PlayerLookup choice = resolvePlayer(players, typed);
  if (!choice.player) {
    AdminAnswer problem = choice.problem;
    if (problem.candidates.empty()) problem.text += " name:" + typed + " bans the name.";
    return refusedPlan(std::move(problem));
  }
  BanPlan plan = planName(ban, choice.player->name);
  const auto address = endpointAddress(choice.player->address);
  if (!address || address->is_loopback()) {
    plan.note = "Only by name, because they play on this machine.";
    return plan;
  }
  const AddressRange range = AddressRange::around(*address);
  const auto others = std::count_if(players.begin(), players.end(), [&](const AdminPlayer& other) {
    const auto theirs = endpointAddress(other.address);
    return other.session != choice.player->session && theirs && range.contains(*theirs);
  });
  if (others > 0) {
    plan.note = "Only by name, because a ban of " + range.text() + " would also affect " +
                counted(static_cast<std::size_t>(others), "other player") + ".";
    return plan;
  }
  Ban of_range = ban;
  of_range.kind = Ban::Kind::kRange;
  of_range.range = range;
  plan.bans.push_back(std::move(of_range));
  return plan;
}

BanPlan planBan(const Ban& ban, const std::vector<AdminPlayer>& players, const std::string& typed) {
  if (const auto range = AddressRange::parse(typed)) return planRange(ban, *range);
  if (ban.kind == Ban::Kind::kException)
    return refusedPlan(AdminAnswer::refused("\"" + typed + "\" is not an address or ADDRESS/BITS."));
  if (typed.starts_with(kNameMark)) return planName(ban, typed.substr(std::string(kNameMark).size()));
  return planPlayer(ban, players, typed);
}

}  // namespace

PlayerLookup resolvePlayer(const std::vector<AdminPlayer>& players, const std::string& typed) {
  std::vector<Fits> ways;
  if (const auto id = idOf(typed)) {
    ways = {[id](const AdminPlayer& player) { return player.id == *id; }};
  } else {
    const std::string low = lowered(typed);
    ways = {[&typed](const AdminPlayer& player) { return player.name == typed; },
            [low](const AdminPlayer& player) { return lowered(player.name) == low; },
            [low](const AdminPlayer& player) { return lowered(player.name).starts_with(low); }};
  }
  for (const Fits& fits : ways) {
    const std::vector<AdminPlayer> found = thoseThat(players, fits);
    if (!found.empty()) return oneOf(found, typed);
  }
  return {std::nullopt, AdminAnswer::refused("There is no player \"" + typed + "\".")};
}

// Runs the job on the host's thread. Can be called from any thread.
void AdminConsole::post(std::function<void()> job) {
  asio::post(m_context.home, std::move(job));
}

void AdminConsole::execute(const AdminRequest& request, const AdminCaller& caller, Done done) {
  const AdminCommand& command = *request.command;
  if (!command.isFor(caller.level, caller.place)) {
    m_context.log("admin: " + caller.name + ": refused: " + request.redacted());
    return done(AdminAnswer::refused("You may not use the command \"" + command.name + "\" here."));
  }
  const bool by_admin = command.level == Level::kAdmin || caller.place == AdminCommand::Frontend::kSocket;
  if (by_admin && !command.only_reads) m_context.log("admin: " + caller.name + ": " + request.redacted());
  if (command.name == "ban" || command.name == "allow") return ban(request, caller, done);
  if (command.name == "unban") return unban(request, done);
  if (command.name == "password") return changePassword(request, std::move(done));
  if (command.name == "reload") return reload(std::move(done));
  if (command.name == "restart" && request.of("when") == "keep" && !request.has("span"))
    return m_admin.handOverRound(std::move(done));
  if (command.name == "scores") return scores(request, std::move(done));
  done(answerNow(request, caller));
}

AdminAnswer AdminConsole::answerNow(const AdminRequest& request, const AdminCaller& caller) {
  const std::string& name = request.command->name;
  if (name == "ping") return AdminAnswer::done("The server is running.");
  if (name == "who") return listPlayers(caller);
  if (name == "status") return {true, "", {}, m_admin.status(), false, {}};
  if (name == "link") return AdminAnswer::done(m_admin.joinCommand());
  if (name == "rooms") return AdminAnswer::list(m_admin.rooms(), "This server has no rooms.");
  if (name == "tell") return tell(request, caller);
  if (name == "kick") return kick(request);
  if (name == "mute" || name == "unmute") return mute(request, name == "mute");
  if (name == "bans") return listBans();
  if (name == "restart") return restart(request);
  if (name == "drain") return m_admin.drain(readTimeSpan(request.of("span")));
  if (name == "cancel") return m_admin.cancel();
  if (name == "set") return set(request);
  if (name == "stop") return m_admin.stop(request.of("reason"));
  if (name == "say") {
    m_admin.broadcast(request.of("text"));
    return AdminAnswer::done("Sent to all players.");
  }
  return AdminAnswer::refused("\"" + name + "\" is not available here.");
}

// ---- players ----------------------------------------------------------------------------------------------

AdminAnswer AdminConsole::listPlayers(const AdminCaller& caller) const {
  std::vector<AdminRow> rows;
  for (const AdminPlayer& player : m_admin.players()) rows.push_back(rowOf(player, caller.level));
  return AdminAnswer::list(std::move(rows), "No players.");
}

// Refuses a muted sender: a muted player must not reach others by private messages either.
AdminAnswer AdminConsole::tell(const AdminRequest& request, const AdminCaller& caller) {
  const std::vector<AdminPlayer> players = m_admin.players();
  const auto sender = std::find_if(players.begin(), players.end(), [&caller](const AdminPlayer& player) {
    return caller.session != 0 && player.session == caller.session;
  });
  if (sender != players.end() && sender->muted) return AdminAnswer::refused("You are muted.");
  const PlayerLookup choice = resolvePlayer(players, request.of("player"));
  if (!choice.player) return choice.problem;
  const std::string from = caller.player.empty() ? "The server" : caller.player;
  m_admin.tell(choice.player->session, from + " tells you: " + request.of("text"));
  return AdminAnswer::done("You told " + choice.player->name + ": " + request.of("text"));
}

AdminAnswer AdminConsole::kick(const AdminRequest& request) {
  const PlayerLookup choice = resolvePlayer(m_admin.players(), request.of("player"));
  if (!choice.player) return choice.problem;
  m_admin.kickPlayer(choice.player->session,
                     withReason("You were removed from the game", request.of("reason")));
  return AdminAnswer::done(choice.player->name + " was removed.");
}

AdminAnswer AdminConsole::mute(const AdminRequest& request, bool muted) {
  const PlayerLookup choice = resolvePlayer(m_admin.players(), request.of("player"));
  if (!choice.player) return choice.problem;
  m_admin.setMuted(choice.player->session, muted);
  return AdminAnswer::done(choice.player->name + (muted ? " is muted." : " is no longer muted."));
}

// ---- bans -------------------------------------------------------------------------------------------------

void AdminConsole::ban(const AdminRequest& request, const AdminCaller& caller, const Done& done) {
  Ban model;
  model.kind = request.command->name == "allow" ? Ban::Kind::kException : Ban::Kind::kRange;
  model.reason = request.of("reason");
  model.by = caller.name;
  model.made = m_bans.time();
  if (const auto span = readTimeSpan(request.of("for"))) model.until = model.made + *span;
  const BanPlan plan = planBan(model, m_admin.players(), request.of("who"));
  if (plan.bans.empty()) return done(plan.problem);
  std::string text;
  for (const Ban& one : plan.bans) text += (text.empty() ? "" : " and ") + one.target();
  text += model.kind == Ban::Kind::kException ? " is exempt from address bans" : " banned";
  text += model.until ? " until " + timeText(*model.until) + "." : " permanently.";
  if (!plan.note.empty()) text += " " + plan.note;
  const auto saved = [this, text, done](const std::string& problem) { answerSaved(text, problem, done); };
  if (!m_bans.add(plan.bans, saved))
    return done(
        AdminAnswer::refused("The ban list is full (" + std::to_string(BanList::kMaxBans) + " bans)."));
  kickBanned();
}

void AdminConsole::unban(const AdminRequest& request, const Done& done) {
  const std::string who = request.of("who");
  const auto saved = [this, done, who](const std::string& problem) {
    answerSaved(oneLine(who) + " was removed from the list.", problem, done);
  };
  if (m_bans.remove(who, saved) == 0)
    done(AdminAnswer::refused("There is no ban of \"" + who + "\"; \"bans\" lists them."));
}

// Called on the worker's thread, or on the host's thread if there is no file or too many jobs wait.
void AdminConsole::answerSaved(const std::string& text, const std::string& problem, const Done& done) {
  post([this, text, problem, done] {
    if (!problem.empty()) m_context.log("bans: " + problem);
    done(AdminAnswer::done(problem.empty() ? text : text + " Not saved: " + problem));
  });
}

void AdminConsole::kickBanned() {
  for (const AdminPlayer& player : m_admin.players()) {
    const auto address = endpointAddress(player.address);
    const std::string sentence = m_bans.refusal(address.value_or(asio::ip::address()), player.name);
    if (!sentence.empty()) m_admin.kickPlayer(player.session, sentence);
  }
}

AdminAnswer AdminConsole::listBans() const {
  std::vector<AdminRow> rows;
  const auto set = m_bans.currentSet();
  for (const Ban& ban : set->all()) {
    if (ban.isExpired(m_bans.time())) continue;
    rows.push_back({{"number", static_cast<std::int64_t>(ban.number)},
                    {"who", ban.target()},
                    {"kind", std::string(ban.kind == Ban::Kind::kException ? "allowed" : "banned")},
                    {"until", ban.until ? timeText(*ban.until) : std::string("permanent")},
                    {"since", timeText(ban.made)},
                    {"by", ban.by},
                    {"reason", ban.reason}});
  }
  return AdminAnswer::list(std::move(rows), "No bans.");
}

// ---- the server -------------------------------------------------------------------------------------------

AdminAnswer AdminConsole::restart(const AdminRequest& request) {
  const std::string when = request.of("when");
  const auto span = readTimeSpan(request.of("span"));
  if ((when == "in") != span.has_value())
    return AdminAnswer::refused("Usage: " + adminUsage(*request.command));
  return m_admin.restart(when == "at-round-end", span);
}

AdminAnswer AdminConsole::set(const AdminRequest& request) {
  if (!request.has("option")) return {true, "", {}, m_admin.settings(), false, {}};
  return m_admin.set(request.of("option"),
                     request.has("value") ? std::optional(request.of("value")) : std::nullopt);
}

void AdminConsole::scores(const AdminRequest& request, Done done) {
  std::optional<std::size_t> count = kScoresOfATable;
  if (request.has("room") && request.has("game"))
    return done(AdminAnswer::refused("Use --room or --game, not both."));
  if (request.has("count")) {
    count = readNumber<std::size_t>(request.of("count"), 1, kMaxScoresOfATable);
    if (!count)
      return done(AdminAnswer::refused("\"" + request.of("count") + "\" is not a number from 1 to " +
                                       std::to_string(kMaxScoresOfATable) + "."));
  }
  m_admin.scores({request.of("table"), *count, request.of("room"), request.of("game")}, std::move(done));
}

// Hashes on the worker's thread, because Argon2id is slow by design.
void AdminConsole::changePassword(const AdminRequest& request, Done done) {
  const std::string password = request.of("password");
  if (password.empty()) return done(m_admin.changePassword(std::nullopt));
  const auto finish = [this, done](std::optional<PasswordHash> hash, const std::string& problem) {
    post([this, done, hash = std::move(hash), problem] {
      done(problem.empty() ? m_admin.changePassword(hash) : AdminAnswer::refused(problem));
    });
  };
  const bool given = m_worker.enqueue([password, finish] {
    try {
      finish(PasswordHash::fromText(password), "");
    } catch (const PasswordError& error) {
      finish(std::nullopt, error.what());
    }
  });
  if (!given) done(AdminAnswer::refused("Busy: too many pending requests. Try again in a moment."));
}

// Reloads the ban file first. If that fails, the answer says so, and the options are reloaded anyway.
void AdminConsole::reload(Done done) {
  const auto loaded = [this, done](std::vector<Ban> bans, const std::string& problem) {
    post([this, done, bans = std::move(bans), problem] {
      if (problem.empty()) {
        m_bans.replaceAll(bans);
        kickBanned();
      }
      m_admin.reload([done, problem](AdminAnswer answer) {
        if (!problem.empty()) answer = AdminAnswer::refused(problem + " " + answer.text);
        done(std::move(answer));
      });
    });
  };
  if (!m_bans.reload(loaded)) m_admin.reload(std::move(done));
}

}  // namespace naiad
