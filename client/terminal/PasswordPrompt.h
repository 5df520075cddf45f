// Asks for a password on the terminal, unseen.
#pragma once

#include <optional>
#include <string>

namespace naiad {

/// Write `prompt` to the terminal of this process and read a line without echo: what stands before its end,
/// at most 255 bytes. The modes of the terminal are restored. Nothing if there is no terminal, or on Ctrl-C
/// or Ctrl-D. Before a TerminalGuard takes the terminal.
std::optional<std::string> askPassword(const std::string& prompt);

}  // namespace naiad
