// Where the control sockets of a user's servers are, if no option says so.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace naiad {

/// The naiad folder in the user's runtime directory ($XDG_RUNTIME_DIR), else in that for state
/// (~/.local/state); nothing without a home.
std::optional<std::filesystem::path> controlFolder();
/// control-PORT.sock in there.
std::optional<std::filesystem::path> controlPath(std::uint16_t port);
/// Is that how such a file is called?
bool isControlName(const std::filesystem::path& path);
/// All such files in the folder, sorted; none if it cannot be read.
std::vector<std::filesystem::path> controlSockets(const std::filesystem::path& folder);

}  // namespace naiad
