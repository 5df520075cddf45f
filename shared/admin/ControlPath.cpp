#include "shared/admin/ControlPath.h"

#include <algorithm>
#include <string>
#include <system_error>

#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

constexpr const char* kBegin = "control-";
constexpr const char* kEnd = ".sock";

}  // namespace

std::optional<std::filesystem::path> controlFolder() {
  return userDirectory("XDG_RUNTIME_DIR", ".local/state");
}

std::optional<std::filesystem::path> controlPath(std::uint16_t port) {
  const auto folder = controlFolder();
  if (!folder) return std::nullopt;
  return *folder / (kBegin + std::to_string(port) + kEnd);
}

bool isControlName(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(kBegin) && name.ends_with(kEnd);
}

std::vector<std::filesystem::path> controlSockets(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (isControlName(entry->path()) && entry->is_socket(error)) found.push_back(entry->path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace naiad
