// The command line of dfctl.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// What a shell completes after "dfctl ", made from the table of commands.
/// A script for "bash", "zsh" or "fish"; nothing for other shells.
std::optional<std::string> ctlCompletion(const std::string& shell);
/// Of dfctl(1), for man: options, commands, environment, exit status.
std::string ctlManSections();
/// What `dfctl --option-page KIND` prints for the build: "man", or a script for a shell; nothing for another.
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
