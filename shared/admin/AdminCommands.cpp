#include "shared/admin/AdminCommands.h"

#include <algorithm>
#include <utility>

#include "shared/options/OptionPages.h"

namespace naiad {

namespace {

using Kind = AdminArgument::Kind;
using Level = AdminCommand::Level;
using Frontend = AdminCommand::Frontend;

const AdminArgument kReason{"reason", Kind::kText, false, "Reason, shown to players"};
const AdminArgument kOnePlayer{"player", Kind::kPlayer, true, "Name, beginning of a name, or #ID"};

using Arguments = std::vector<AdminArgument>;
constexpr bool kOnlyReads = true;

/// Makes a command that every player may give.
AdminCommand ofPlayers(std::string name, Frontend place, std::string help, Arguments arguments = {},
                       bool only_reads = false) {
  return {std::move(name), Level::kPlayer, place, std::move(help), std::move(arguments), only_reads};
}

AdminCommand ofAdmins(std::string name, Frontend place, std::string help, Arguments arguments = {},
                      bool only_reads = false) {
  return {std::move(name), Level::kAdmin, place, std::move(help), std::move(arguments), only_reads};
}

std::vector<AdminCommand> tableOfCommands() {
  return {
      ofPlayers("help", Frontend::kBoth, "List the commands that you may give, or say how to use one",
                {{"command", Kind::kWord, false, "Name of a command"}}),
      ofPlayers("commands", Frontend::kChat, "Like help"),
      ofPlayers("who", Frontend::kBoth, "List the players", {}, kOnlyReads),
      ofPlayers("rooms", Frontend::kBoth, "List the server's rooms and the number of players in each", {},
                kOnlyReads),
      ofPlayers("tell", Frontend::kBoth, "Send a line to one player only",
                {kOnePlayer, {"text", Kind::kText, true, "The line"}}),
      ofPlayers("vote", Frontend::kChat, "Start a vote to kick a player, or agree with the current vote",
                {{"what", Kind::kChoice, true, "Subject of the vote", {"kick"}}, kOnePlayer}),
      ofPlayers("admin", Frontend::kChat, "Get an admin's rights until your connection ends",
                {{"password", Kind::kSecret, true, "The server's --admin-password"}}),
      ofAdmins("status", Frontend::kBoth, "Show the server's status", {}, kOnlyReads),
      ofAdmins("link", Frontend::kBoth, "Show the command with which players join", {}, kOnlyReads),
      ofAdmins("say", Frontend::kBoth, "Send a line to all players",
               {{"text", Kind::kText, true, "The line"}}),
      ofAdmins("kick", Frontend::kBoth, "End a player's session; they may join again", {kOnePlayer, kReason}),
      ofAdmins("ban", Frontend::kBoth,
               "Ban a player (name and address), a name, an address or a range of addresses",
               {{"who", Kind::kTarget, true, "Player, name:NAME, address or ADDRESS/BITS"},
                {"for", Kind::kSpan, false, "Duration with its unit, like 30m, 2h or 7d; default: forever"},
                kReason}),
      ofAdmins("allow", Frontend::kBoth, "Make an exception: bans do not apply to these addresses",
               {{"who", Kind::kTarget, true, "Address or ADDRESS/BITS"},
                {"for", Kind::kSpan, false, "Duration with its unit; default: forever"},
                kReason}),
      ofAdmins(
          "unban", Frontend::kBoth, "Lift a ban or an exception",
          {{"who", Kind::kTarget, true, "#NUMBER as listed by bans, name:NAME, address or ADDRESS/BITS"}}),
      ofAdmins("bans", Frontend::kBoth, "List bans and exceptions", {}, kOnlyReads),
      ofAdmins("scores", Frontend::kSocket, "List the best saved scores of one table or of all",
               {{"table", Kind::kWord, false, "Name of a table of the game"},
                {"count", Kind::kWord, false, "Rows of a table, at most 10000; default: 10"},
                {"room", Kind::kWord, false, "Only of the game in this room", {}, true},
                {"game", Kind::kWord, false, "Only of this game, if the rooms run several", {}, true}},
               kOnlyReads),
      ofAdmins("mute", Frontend::kBoth, "Block a player's chat and private lines", {kOnePlayer}),
      ofAdmins("unmute", Frontend::kBoth, "Allow a muted player to chat again", {kOnePlayer}),
      ofAdmins("password", Frontend::kBoth, "Change the password that players need; empty: no password",
               {{"password", Kind::kSecret, true,
                 "The new password (if left out, dfctl reads it from standard input)"}}),
      ofAdmins("set", Frontend::kBoth,
               "Change an option of the running server, or list those that can be changed",
               {{"option", Kind::kWord, false, "Name of the option, without dashes"},
                {"value", Kind::kText, false, "Its new value"}}),
      ofAdmins("reload", Frontend::kBoth, "Reload options, certificate and bans"),
      ofAdmins("restart", Frontend::kBoth, "Restart the server; players reconnect automatically",
               {{"when",
                 Kind::kChoice,
                 false,
                 "now (the default), at-round-end, in SPAN, or keep: continue the round in the installed "
                 "program, if that replays it identically",
                 {"now", "at-round-end", "in", "keep"}},
                {"span", Kind::kSpan, false, "With in: time to wait"}}),
      ofAdmins("drain", Frontend::kBoth, "Refuse new players, and stop the server when all players have left",
               {{"span", Kind::kSpan, false, "Maximum time to wait"}}),
      ofAdmins("stop", Frontend::kBoth, "Stop the server now", {kReason}),
      ofAdmins("cancel", Frontend::kBoth, "Cancel a restart or drain"),
      ofAdmins("watch", Frontend::kSocket, "Print the server's log as it is written, until interrupted"),
      ofAdmins("ping", Frontend::kSocket, "Ask whether the server answers", {}, kOnlyReads),
  };
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return text;
}

std::string placeholder(const AdminArgument& argument) {
  if (argument.named) return "--" + argument.name + " " + upper(argument.name);
  if (argument.kind != Kind::kChoice) return upper(argument.name);
  std::string all;
  for (const std::string& one : argument.one_of) all += (all.empty() ? "" : "|") + one;
  return all;
}

std::string whereGiven(const AdminCommand& command) {
  if (command.place == Frontend::kSocket) return "dfctl";
  const std::string who = command.level == Level::kPlayer ? "every player" : "admins";
  return command.place == Frontend::kChat ? "chat, " + who : "dfctl; chat, " + who;
}

}  // namespace

const std::vector<AdminCommand>& adminCommands() {
  static const std::vector<AdminCommand> commands = tableOfCommands();
  return commands;
}

const AdminCommand* findAdminCommand(std::string_view name) {
  const auto& all = adminCommands();
  const auto found =
      std::find_if(all.begin(), all.end(), [name](const auto& one) { return one.name == name; });
  return found != all.end() ? &*found : nullptr;
}

std::string adminUsage(const AdminCommand& command) {
  std::string usage = command.name;
  for (const AdminArgument& argument : command.arguments) {
    const std::string text = placeholder(argument);
    usage += argument.required ? " " + text : " [" + text + "]";
  }
  return usage;
}

std::vector<std::string> adminHelp(Level level, Frontend place) {
  std::size_t width = 0;
  for (const AdminCommand& command : adminCommands()) {
    if (command.isFor(level, place)) width = std::max(width, adminUsage(command).size());
  }
  std::vector<std::string> lines;
  for (const AdminCommand& command : adminCommands()) {
    if (!command.isFor(level, place)) continue;
    std::string line = adminUsage(command);
    line.resize(width + 2, ' ');
    lines.push_back(line + command.help);
  }
  return lines;
}

std::vector<std::string> adminHelp(const AdminCommand& command) {
  std::vector<std::string> lines{adminUsage(command) + ": " + command.help};
  for (const AdminArgument& argument : command.arguments)
    lines.push_back("  " + upper(argument.name) + ": " + argument.help);
  return lines;
}

std::string adminManSection() {
  std::string text = ".SH COMMANDS\n";
  for (const AdminCommand& command : adminCommands()) {
    if (command.place == Frontend::kChat) continue;
    text += ".TP\n.B " + roff(adminUsage(command)) + "\n" + roff(command.help) + ".\n";
    for (const AdminArgument& argument : command.arguments)
      text += ".br\n\\fI" + roff(upper(argument.name)) + "\\fR: " + roff(argument.help) + ".\n";
  }
  return text;
}

std::string adminMarkdown() {
  std::string text = "| command | where | what it does |\n|---|---|---|\n";
  for (const AdminCommand& command : adminCommands()) {
    std::string usage = adminUsage(command);
    for (std::size_t at = 0; (at = usage.find('|', at)) != std::string::npos; at += 2) usage.insert(at, "\\");
    text += "| `" + usage + "` | " + whereGiven(command) + " | " + command.help + " |\n";
  }
  return text;
}

}  // namespace naiad
