// What a door asks its visitor before the game, in lines on their terminal.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace naiad {

/// Write `question` and read a line, at most 200 bytes of it. Nothing if none comes within `patience`, or the
/// terminal is gone, or the line is longer.
std::optional<std::string> askLine(const std::string& question, std::chrono::seconds patience);

/// Which of these to play, by its number or name. Nothing after three answers that are none, or as askLine().
std::optional<std::size_t> askChoice(const std::vector<std::string>& names, std::chrono::seconds patience);

/// Their name in the game; `known` if the line is empty. Nothing as askLine().
std::optional<std::string> askName(const std::string& known, std::chrono::seconds patience);

/// Yes unless the line begins with n or N. Nothing as askLine().
std::optional<bool> askYes(const std::string& question, std::chrono::seconds patience);

}  // namespace naiad
