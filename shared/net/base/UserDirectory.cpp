#include "shared/net/base/UserDirectory.h"

#include <cstdlib>

namespace naiad {

std::optional<std::filesystem::path> userDirectory(const char* variable, const char* fallback) {
  // Relative paths are to be ignored, says the specification.
  const char* const chosen = std::getenv(variable);
  if (chosen && *chosen == '/') return std::filesystem::path(chosen) / "naiad";
  const char* const home = std::getenv("HOME");
  if (home && *home == '/') return std::filesystem::path(home) / fallback / "naiad";
  return std::nullopt;
}

}  // namespace naiad
