#include "host/world/WorldStart.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace naiad {

namespace {

constexpr const char* kVariable = "NAIAD_WORLD_SOCKET";

std::string workingDirectory() {
  std::error_code error;
  return std::filesystem::current_path(error).string();
}

const std::string& g_began_in = *new std::string(workingDirectory());

}  // namespace

const std::string& firstDirectory() {
  return g_began_in;
}

std::string worldSocketEntry() {
  return std::string(kVariable) + "=" + std::to_string(kWorldSocket);
}

std::optional<int> takeWorldSocket() {
  const char* p_said = std::getenv(kVariable);
  if (p_said == nullptr) return std::nullopt;
  const std::string_view text(p_said);
  int socket = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), socket);
  const bool good = error == std::errc() && end == text.data() + text.size() && socket > STDERR_FILENO;
  unsetenv(kVariable);  // programs that the game starts are no worlds
  if (!good || fcntl(socket, F_SETFD, FD_CLOEXEC) != 0) return std::nullopt;
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
