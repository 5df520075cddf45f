// The command line of dfctl.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// Returns the completion script of dfctl for "bash", "zsh" or "fish", made from the table of commands;
/// nothing for other shells.
std::optional<std::string> ctlCompletion(const std::string& shell);
/// Returns the sections of the man page dfctl(1): options, commands, environment, exit status.
std::string ctlManSections();
/// Returns what `dfctl --option-page KIND` prints: ctlManSections() if `kind` is "man", ctlCompletion() if it
/// is the name of a shell; nullopt for any other kind.
std::optional<std::string> ctlPage(const std::string& kind);

struct CtlCommandLine {
  std::string control;  ///< path of the socket; empty: the one there is
  bool json = false;
  std::vector<std::string> words;  ///< the command, and what follows
};

/// Words that begin with -- in front of the command are dfctl's own options; --json may be the last word,
/// too. Throws AdminUsageError (AdminRequest.h). The socket may come from NAIAD_CONTROL.
CtlCommandLine readCtlCommandLine(const std::vector<std::string>& words);

/// What --help prints.
std::string ctlHelp();

}  // namespace naiad
