#include "LogFile.h"

#include <cstdio>
#include <mutex>

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

}  // namespace df
