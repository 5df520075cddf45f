#include "LogManager.h"

#include <cstdarg>
#include <cstdio>
#include <utility>

#include "Started.h"
#include "World.h"

namespace df {

namespace {

int writeFormatted(const char* fmt, std::va_list args) {
  std::va_list again;
  va_copy(again, args);
  const int length = std::vsnprintf(nullptr, 0, fmt, args);
  std::string line(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  if (length > 0) std::vsnprintf(line.data(), line.size() + 1, fmt, again);
  va_end(again);
  if (length < 0) return -1;
  if (!line.empty() && line.back() == '\n') line.pop_back();
  World::current().log(line);
  return length;
}

}  // namespace

LogManager& LogManager::getInstance() {
  static LogManager* p_instance = new LogManager;
  return *p_instance;
}

int LogManager::startUp() {
  World::current().setStarted(kLogStarted, true);
  return 0;
}

void LogManager::shutDown() {
  World::current().setStarted(kLogStarted, false);
}

bool LogManager::isStarted() const {
  return World::current().isStarted(kLogStarted);
}

int LogManager::writeLog(const char* fmt, ...) const {
  std::va_list args;
  va_start(args, fmt);
  const int length = writeFormatted(fmt, args);
  va_end(args);
  return length;
}

int LogManager::writeLog(int log_level, const char* fmt, ...) const {
  if (log_level > getLogLevel()) return 0;
  std::va_list args;
  va_start(args, fmt);
  const int length = writeFormatted(fmt, args);
  va_end(args);
  return length;
}

void LogManager::setLogLevel(int new_log_level) {
  World::current().setLogLevel(new_log_level);
}

int LogManager::getLogLevel() const {
  return World::current().getLogLevel();
}

void LogManager::setFlush(bool do_flush) {
  World::current().setLogFlush(do_flush);
}

void LogManager::setSink(std::function<void(const std::string&)> sink) {
  World::current().setLogSink(std::move(sink));
}

}  // namespace df
