// Texts from players and games, made safe for log lines.
#pragma once

#include <string>
#include <string_view>

namespace naiad {

/// Returns the text with control characters (C0, DEL, C1) as \n, \t, \xNN, so that it stays on its line.
std::string oneLine(std::string_view text);

/// Like oneLine(), in double quotes and with \" and \\ for those inside: the end of the text is unambiguous.
std::string inQuotes(std::string_view text);

}  // namespace naiad
