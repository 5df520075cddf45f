// Password input from the terminal, without echo.
#pragma once

#include <optional>
#include <string>

namespace naiad {

/// Writes `prompt` to the terminal of this process and reads a line without echo, at most 255 bytes. Restores
/// the modes of the terminal. Nullopt if there is no terminal, the line is longer, or on Ctrl-C or Ctrl-D.
/// Call before a TerminalGuard takes the terminal.
std::optional<std::string> readHiddenLine(const std::string& prompt);

}  // namespace naiad
