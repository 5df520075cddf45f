// Where a user's files of one kind lie (XDG Base Directory Specification 0.8).
#pragma once

#include <filesystem>
#include <optional>

namespace naiad {

/// $variable/naiad if that is an absolute path, else $HOME/fallback/naiad; nothing if HOME is not set either.
/// ("XDG_CONFIG_HOME", ".config"), ("XDG_DATA_HOME", ".local/share").
std::optional<std::filesystem::path> userDirectory(const char* variable, const char* fallback);

}  // namespace naiad
