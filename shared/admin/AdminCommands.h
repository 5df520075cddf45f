// The table of commands that manage a running server. It defines dfctl's commands, the lines in the chat that
// begin with /, the help, the completions and the manual page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace naiad {

struct AdminArgument {
  enum class Kind {
    kWord,    ///< any word
    kPlayer,  ///< a player: #ID, a name, or the beginning of a name
    kTarget,  ///< the target of a ban: a player, a name, an address or an address range
    kSpan,    ///< a time span: 90, 30m, 2h, 7d; if optional, skipped if the word is not a span, or has
              ///< no unit and a text may follow
    kChoice,  ///< one of the words `one_of`, also after "--"; if optional, skipped if the word is another
    kSecret,  ///< a password, which no log contains
    kText,    ///< the rest of the line
  };

  std::string name;  ///< name in help and JSON, for example "player"
  Kind kind = Kind::kWord;
  bool required = true;
  std::string help;
  std::vector<std::string> one_of{};
  bool named = false;  ///< given as --NAME VALUE or --NAME=VALUE, anywhere after the command
};

struct AdminCommand {
  /// The rank needed to give the command. Users of the control socket are admins.
  enum class Level { kPlayer, kAdmin };
  enum class Frontend { kBoth, kSocket, kChat };

  std::string name;
  Level level = Level::kAdmin;
  Frontend place = Frontend::kBoth;
  std::string help;
  std::vector<AdminArgument> arguments{};
  bool only_reads = false;  ///< changes nothing, so frequent calls by programs are not logged

  bool isFor(Level who, Frontend where) const {
    return level <= who && (place == Frontend::kBoth || place == where);
  }
};

/// Returns all commands, grouped by purpose, in the order in which help lists them.
const std::vector<AdminCommand>& adminCommands();
/// Returns the command of this name; nullptr if there is none.
const AdminCommand* findAdminCommand(std::string_view name);

/// Returns the command and its arguments, for example "ban WHO [FOR] [REASON]".
std::string adminUsage(const AdminCommand& command);
/// Returns a line with usage and help, in two columns, for each command that `level` allows at `place`.
std::vector<std::string> adminHelp(AdminCommand::Level level, AdminCommand::Frontend place);
/// Returns the usage, help and arguments of one command.
std::vector<std::string> adminHelp(const AdminCommand& command);
/// Returns the COMMANDS section of dfctl(1), in man macros.
std::string adminManSection();
/// Returns the table as Markdown, for docs/hosting.md.
std::string adminMarkdown();

}  // namespace naiad
