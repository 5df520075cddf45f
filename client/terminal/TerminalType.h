// Chooses the terminal description that ncurses draws with, before the client joins a server.
//
// Terminals put their type in TERM. Some (kitty, foot, ghostty, wezterm) have types that a system's database
// does not have yet; all of them understand xterm's sequences.
#pragma once

#include <string>
#include <string_view>

namespace naiad {

struct TerminalType {
  std::string name;    ///< terminal type for which there is a description
  std::string notice;  ///< message for the player if `name` is not TERM; otherwise empty
};

/// Returns the type for the value of TERM; null: not set. Throws std::runtime_error, with a sentence for
/// people, if TERM is not set, its terminal cannot be drawn on, or no description is found.
TerminalType chooseTerminalType(const char* p_term);

/// Returns a common terminal's compiled-in description, for systems without a database (bare containers,
/// other Unixes), as a value of ncurses' TERMINFO ("b64:…"); null if the name is unknown. Never freed.
const char* builtInTerminal(std::string_view name);

}  // namespace naiad
