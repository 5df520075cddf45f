#include "engine/managers/LogManager.h"

#include <cstdarg>
#include <cstdio>
#include <optional>
#include <utility>

#include "engine/world/LogFile.h"
#include "engine/world/Started.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"

namespace df {

namespace {

bool isWanted(int log_level) {
  const World& world = World::current();
  return world.compat() ? log_level >= world.log().level() : log_level <= world.log().level();
}

// Returns the formatted text; nullopt if `fmt` is not a valid format for `args`.
std::optional<std::string> format(const char* fmt, std::va_list args) {
  std::va_list again;
  va_copy(again, args);
  const int length = std::vsnprintf(nullptr, 0, fmt, args);
  std::string line(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  if (length > 0) std::vsnprintf(line.data(), line.size() + 1, fmt, again);
  va_end(again);
  if (length < 0) return std::nullopt;
  return line;
}

int writeToOwnFile(const std::string& filename, const std::string& line) {
  if (!writeToFile(filename, line)) return -1;
  return static_cast<int>(line.size());
}

int writeFormatted(const char* fmt, std::va_list args) {
  std::optional<std::string> line = format(fmt, args);
  if (!line) return -1;
  const int length = static_cast<int>(line->size());
  if (length > 0 && line->back() == '\n') line->pop_back();
  World::current().log().write(*line);
  return length;
}

}  // namespace

LogManager::LogManager() : Manager("LogManager", kLogStarted) {}

LogManager& LogManager::getInstance() {
  static LogManager* p_instance = new LogManager;
  return *p_instance;
}

int LogManager::writeLog(const char* fmt, ...) const {
  std::va_list args;
  va_start(args, fmt);
  const int length = writeFormatted(fmt, args);
  va_end(args);
  return length;
}

int LogManager::writeLog(int log_level, const char* fmt, ...) const {
  if (!isWanted(log_level)) return 0;
  std::va_list args;
  va_start(args, fmt);
  const int length = writeFormatted(fmt, args);
  va_end(args);
  return length;
}

int LogManager::writeMyLog(const std::string& filename, const char* fmt, ...) const {
  std::va_list args;
  va_start(args, fmt);
  const std::optional<std::string> line = format(fmt, args);
  va_end(args);
  return line ? writeToOwnFile(filename, *line) : -1;
}

int LogManager::writeMyLog(const std::string& filename, int log_level, const char* fmt, ...) const {
  if (!isWanted(log_level)) return 0;
  std::va_list args;
  va_start(args, fmt);
  const std::optional<std::string> line = format(fmt, args);
  va_end(args);
  return line ? writeToOwnFile(filename, *line) : -1;
}

void LogManager::setLogLevel(int new_log_level) {
  World::current().log().setLevel(new_log_level);
}

int LogManager::getLogLevel() const {
  return World::current().log().level();
}

void LogManager::setFlush(bool do_flush) {
  World::current().log().setFlush(do_flush);
}

void LogManager::setSink(std::function<void(const std::string&)> sink) {
  World::current().log().setSink(std::move(sink));
}

}  // namespace df
