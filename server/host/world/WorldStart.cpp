#include "host/world/WorldStart.h"

#include <fcntl.h>
#include <limits.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cstdlib>
#include <string_view>
#include <system_error>
#include <utility>

#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

constexpr const char* kVariable = "NAIAD_WORLD_SOCKET";
constexpr const char* kSeedVariable = "NAIAD_WORLD_SEED";

// Reserves a fixed amount of memory, so that later allocations in a world's process have equal addresses.
std::string workingDirectory() {
  char path[PATH_MAX];
  std::string text;
  text.reserve(sizeof path);
  if (getcwd(path, sizeof path) != nullptr) text = path;
  return text;
}

const std::string& g_began_in = *new std::string(workingDirectory());

}  // namespace

const std::string& firstDirectory() {
  return g_began_in;
}

std::string worldSocketEntry() {
  return std::string(kVariable) + "=" + std::to_string(kWorldSocket);
}

std::string worldSeedEntry(std::uint64_t seed) {
  return std::string(kSeedVariable) + "=" + std::to_string(seed);
}

std::optional<std::uint64_t> takeWorldSeed() {
  const char* p_said = std::getenv(kSeedVariable);
  if (p_said == nullptr) return std::nullopt;
  const auto seed = readNumber<std::uint64_t>(p_said, 0, UINT64_MAX);
  unsetenv(kSeedVariable);
  return seed;
}

std::optional<int> takeWorldSocket() {
  const char* p_said = std::getenv(kVariable);
  if (p_said == nullptr) return std::nullopt;
  const auto socket = readNumber(p_said, STDERR_FILENO + 1, INT_MAX);
  unsetenv(kVariable);  // programs that the game starts are not worlds
  if (!socket || fcntl(*socket, F_SETFD, FD_CLOEXEC) != 0) return std::nullopt;
  fcntl(kWorldCheckpoints, F_SETFD, FD_CLOEXEC);  // no effect if there is no such socket
  return socket;
}

df::ActivityPage* openWorldPage() {
  struct stat facts {};
  if (fstat(kWorldPage, &facts) != 0 || facts.st_size != sizeof(df::ActivityPage)) return nullptr;
  void* p_memory = mmap(nullptr, sizeof(df::ActivityPage), PROT_READ | PROT_WRITE, MAP_SHARED, kWorldPage, 0);
  if (p_memory == MAP_FAILED) return nullptr;
  close(kWorldPage);
  return static_cast<df::ActivityPage*>(p_memory);
}

}  // namespace naiad
