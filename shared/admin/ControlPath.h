// Default paths of the control sockets of a user's servers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace naiad {

/// Returns the naiad folder in $XDG_RUNTIME_DIR, else in $HOME/.local/state; nullopt if neither is absolute.
std::optional<std::filesystem::path> controlFolder();
/// Returns the path of control-PORT.sock in controlFolder(); nullopt without that folder.
std::optional<std::filesystem::path> controlPath(std::uint16_t port);
/// True if the file name is of the form control-*.sock.
bool isControlName(const std::filesystem::path& path);
/// Returns all control sockets in the folder, sorted; none if the folder cannot be read.
std::vector<std::filesystem::path> controlSockets(const std::filesystem::path& folder);

}  // namespace naiad
