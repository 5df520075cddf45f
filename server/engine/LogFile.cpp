#include "LogFile.h"

#include <cstdio>
#include <mutex>
#include <set>

namespace df {

void writeToLogFile(const std::string& line, bool flush) {
  static std::mutex* p_mutex = new std::mutex;  // for ever, like the default world
  static std::FILE* p_file = nullptr;
  static bool opened = false;
  const std::lock_guard lock(*p_mutex);
  if (!opened) p_file = std::fopen("dragonfly.log", "w");
  opened = true;
  if (p_file == nullptr) return;
  std::fwrite(line.data(), 1, line.size(), p_file);
  std::fputc('\n', p_file);
  if (flush) std::fflush(p_file);
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
