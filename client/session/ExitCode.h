// How dfclient and dfbot end. The numbers are documented in --help and used by scripts.
#pragma once

namespace naiad {

enum ExitCode {
  kExitLeft = 0,         ///< the player left, or the bot did what it should
  kExitUnreachable = 1,  ///< no connection to the server
  kExitUsage = 2,        ///< wrong command line or script, as of dfserver
  kExitRefused = 3,      ///< the server refused; its sentence is on stderr
  kExitEnded = 4,        ///< the server ended the game, or was lost for good
  kExitNoTerminal = 5,   ///< standard input or output is no terminal that can be drawn on
  kExitUnproven = 6,     ///< what the bot saw is not what the truth file says, or could not be compared
};

/// The part of --help that both programs share.
inline constexpr const char* kExitCodeHelp =
    "Exit codes:\n"
    "  0  left                      3  refused by the server (its sentence is on stderr)\n"
    "  1  cannot connect            4  the server ended the game, or was lost for good\n"
    "  2  wrong usage               5  no terminal (dfclient)\n"
    "  6  wrong cells, or nothing to compare (dfbot --truth)\n";

}  // namespace naiad
