// How an author sees where a game of theirs died.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace naiad {

/// What to type in a shell: "dfreplay FILE --until TICK --debug", with --game where `game` is the name of no
/// installed game, or of another one than `module` (both as of GameModule).
std::string debugCommand(const std::string& file, std::uint32_t tick, const std::string& game,
                         const std::filesystem::path& module);

/// One word of a shell's line.
std::string shellWord(const std::string& text);

}  // namespace naiad
