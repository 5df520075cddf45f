#include "engine/world/LogFile.h"

#include <fcntl.h>

#include <atomic>
#include <cstdio>
#include <map>
#include <mutex>
#include <set>

namespace df {

namespace {

constinit std::atomic<bool> g_kept = false;

// Empty, and every line goes to its end, wherever that is then.
std::FILE* openEmpty(const std::string& filename) {
  const int empty = g_kept ? 0 : O_TRUNC;
  const int file = ::open(filename.c_str(), O_WRONLY | O_CREAT | empty | O_APPEND | O_CLOEXEC, 0666);
  return file < 0 ? nullptr : ::fdopen(file, "a");
}

}  // namespace

void writeToLogFile(const std::string& filename, const std::string& line, bool flush) {
  static std::mutex* p_mutex = new std::mutex;  // for ever, like the default world
  static auto* p_files = new std::map<std::string, std::FILE*>;
  const std::lock_guard lock(*p_mutex);
  const auto [entry, is_new] = p_files->try_emplace(filename);
  if (is_new) entry->second = openEmpty(filename);
  std::FILE* p_file = entry->second;
  if (p_file == nullptr) return;
  std::fwrite(line.data(), 1, line.size(), p_file);
  std::fputc('\n', p_file);
  if (flush) std::fflush(p_file);
}

void keepLogFiles() {
  g_kept = true;
}

bool writeToFile(const std::string& filename, const std::string& line) {
  static std::mutex* p_mutex = new std::mutex;
  static auto* p_known = new std::set<std::string>;
  const std::lock_guard lock(*p_mutex);
  std::FILE* p_file = std::fopen(filename.c_str(), p_known->insert(filename).second ? "w" : "a");
  if (p_file == nullptr) return false;
  std::fwrite(line.data(), 1, line.size(), p_file);
  if (line.empty() || line.back() != '\n') std::fputc('\n', p_file);
  return std::fclose(p_file) == 0;
}

}  // namespace df
