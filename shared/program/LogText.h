// Texts from players and games in log lines.
#pragma once

#include <string>
#include <string_view>

namespace naiad {

/// The text with control characters (C0, DEL, C1) as \n, \t, \xNN, so that it stays in its line.
std::string oneLine(std::string_view text);

/// The same in double quotes, with \" and \\ for those inside: where the text ends is seen, whatever it is.
std::string inQuotes(std::string_view text);

}  // namespace naiad
