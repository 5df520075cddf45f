// The commands by which a running server is looked after, in one table: dfctl, the lines beginning with / in
// the chat, help, completions and the manual page are made from it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace naiad {

struct AdminArgument {
  enum class Kind {
    kWord,    ///< anything without a meaning of its own
    kPlayer,  ///< #ID, or a name, or the beginning of one
    kTarget,  ///< of a ban: a player, a name, an address or a range of them
    kSpan,    ///< 90s, 30m, 2h, 7d; one that is optional and is not there is skipped
    kChoice,  ///< one of `one_of`; -- in front is ignored
    kSecret,  ///< a password: written to no log
    kText,    ///< the rest of the line
  };

  std::string name;  ///< as in JSON: "player"
  Kind kind = Kind::kWord;
  bool required = true;
  std::string help;
  std::vector<std::string> one_of{};
  bool named = false;  ///< given as --NAME VALUE or --NAME=VALUE, anywhere behind the command
};

struct AdminCommand {
  /// Who may give it. Whoever can open the control socket is an admin.
  enum class Level { kPlayer, kAdmin };
  enum class Place { kBoth, kSocket, kChat };

  std::string name;
  Level level = Level::kAdmin;
  Place place = Place::kBoth;
  std::string help;
  std::vector<AdminArgument> arguments{};
  bool only_reads =
      false;  ///< it changes nothing: programs may give it all the time, without a line of the log

  bool isFor(Level who, Place where) const {
    return level <= who && (place == Place::kBoth || place == where);
  }
};

/// All of them, by purpose, as help lists them.
const std::vector<AdminCommand>& adminCommands();
/// Null if there is none of this name.
const AdminCommand* findAdminCommand(std::string_view name);

/// "ban WHO [FOR] [REASON]".
std::string adminUsage(const AdminCommand& command);
/// A line for each command that this level has at this place: usage and help, in two columns.
std::vector<std::string> adminHelp(AdminCommand::Level level, AdminCommand::Place place);
/// Usage, help and arguments of one.
std::vector<std::string> adminHelp(const AdminCommand& command);
/// dfctl(1), section COMMANDS, in man's macros.
std::string adminManSection();
/// The table as Markdown, for docs/hosting.md.
std::string adminMarkdown();

}  // namespace naiad
