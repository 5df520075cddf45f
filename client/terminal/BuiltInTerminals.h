// Descriptions of common terminals, compiled in for systems that have none: bare containers, other Unixes.
#pragma once

#include <string_view>

namespace naiad {

/// A compiled terminal description as ncurses takes it in the variable TERMINFO ("b64:…"), made from the
/// building system's database; null if there is none of this name. Lives as long as the program.
const char* builtInTerminal(std::string_view name);

}  // namespace naiad
