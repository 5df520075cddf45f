// The command line of dfctl.
#pragma once

#include <string>
#include <vector>

namespace naiad {

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
