// Which description of the terminal ncurses draws with, found out before anything is joined.
//
// Terminals name themselves in TERM, and some (kitty, foot, ghostty, wezterm) by names that a system's
// descriptions do not have yet. They all understand what xterm does.
#pragma once

#include <string>
#include <string_view>

namespace naiad {

struct TerminalType {
  std::string name;    ///< of a description that there is
  std::string notice;  ///< for the player, if it is not the one that TERM names; else empty
};

/// For the value of TERM; null if it is not set. Throws std::runtime_error, with a sentence for people, if it
/// names none, or one on which nothing can be drawn, or if there are no descriptions at all.
TerminalType chooseTerminalType(const char* p_term);

/// One of the descriptions of common terminals that are compiled in, for systems that have none: bare
/// containers, other Unixes. As ncurses takes it in the variable TERMINFO ("b64:…"); null if there is none of
/// this name. Lives as long as the program.
const char* builtInTerminal(std::string_view name);

}  // namespace naiad
