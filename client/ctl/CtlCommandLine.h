// The command line of dfctl.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// Returns dfctl's completion script for "bash", "zsh" or "fish", from the table of commands; else nullopt.
std::optional<std::string> ctlCompletion(const std::string& shell);
/// Returns the sections of the man page dfctl(1): options, commands, environment, exit status.
std::string ctlManSections();
/// Returns the output of `dfctl --option-page KIND`: ctlManSections() if `kind` is "man", ctlCompletion() if
/// it is the name of a shell; nullopt for any other kind.
std::optional<std::string> ctlPage(const std::string& kind);

struct CtlCommandLine {
  std::string control;  ///< path of the socket; empty: that of the only server
  bool json = false;
  std::vector<std::string> words;  ///< the command and its arguments
};

/// Parses dfctl's arguments. dfctl's own options come before the command; --json may also be the last word.
/// The default of `control` is the value of NAIAD_CONTROL. Throws AdminUsageError (AdminRequest.h).
CtlCommandLine readCtlCommandLine(const std::vector<std::string>& words);

std::string ctlHelp();

}  // namespace naiad
