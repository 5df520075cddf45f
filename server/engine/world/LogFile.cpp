#include "engine/world/LogFile.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <set>

namespace df {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kRetry{1};  ///< time before another attempt to open a file

constinit std::atomic<bool> g_kept = false;

/// Opens a file without waiting, because a pipe that nothing reads must not stop the game; lines for such a
/// pipe are lost. Returns null if the file cannot be opened.
std::FILE* openToWrite(const std::string& filename, int how) {
  constexpr int kAlways = O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;
  const int file = ::open(filename.c_str(), kAlways | how, 0640);
  if (file < 0) return nullptr;
  std::FILE* p_file = ::fdopen(file, "a");
  if (p_file == nullptr) ::close(file);
  return p_file;
}

struct OpenFile {
  std::FILE* p_file = nullptr;
  Clock::time_point next_try{};
};

}  // namespace

// Opens the file with O_APPEND, because other processes may append to it, too.
void writeToLogFile(const std::string& filename, const std::string& line, bool flush) {
  static std::mutex* p_mutex = new std::mutex;  // never destroyed, like the default world
  static auto* p_files = new std::map<std::string, OpenFile>;
  const std::lock_guard lock(*p_mutex);
  OpenFile& entry = (*p_files)[filename];
  if (entry.p_file == nullptr) {
    const auto now = Clock::now();
    if (now < entry.next_try) return;
    entry.next_try = now + kRetry;
    entry.p_file = openToWrite(filename, O_APPEND | (g_kept ? 0 : O_TRUNC));
    if (entry.p_file == nullptr) return;
  }
  std::fwrite(line.data(), 1, line.size(), entry.p_file);
  std::fputc('\n', entry.p_file);
  if (flush) std::fflush(entry.p_file);
}

void disableLogTruncation() {
  g_kept = true;
}

bool writeToFile(const std::string& filename, const std::string& line) {
  static std::mutex* p_mutex = new std::mutex;
  static auto* p_known = new std::set<std::string>;
  const std::lock_guard lock(*p_mutex);
  std::FILE* p_file = openToWrite(filename, p_known->insert(filename).second ? O_TRUNC : O_APPEND);
  if (p_file == nullptr) return false;
  std::fwrite(line.data(), 1, line.size(), p_file);
  if (line.empty() || line.back() != '\n') std::fputc('\n', p_file);
  return std::fclose(p_file) == 0;
}

}  // namespace df
