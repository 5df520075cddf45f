// Writes log lines (book, Listing 4.6).
//
// Lines go to the current world's sink. If it has none, they go to the file dragonfly.log in the working
// directory, or to the file in the setting `logfile`. This file is emptied for the first line of a process.
#pragma once

#include <functional>
#include <string>
#include <type_traits>

#include "Manager.h"
#include "StandardHeaders.h"
#include "detail/Settings.h"

#define LM df::LogManager::getInstance()

namespace df {

class LogManager : public Manager {
 public:
  static LogManager& getInstance();

  /// Writes one line, formatted like printf(); a newline at its end is optional. Returns the number of
  /// characters, or -1 for a bad format.
  int writeLog(const char* fmt, ...) const __attribute__((format(printf, 2, 3)));
  /// Like writeLog(fmt) if `log_level` <= getLogLevel() (compat: >=); otherwise does nothing and returns 0.
  int writeLog(int log_level, const char* fmt, ...) const __attribute__((format(printf, 3, 4)));
  /// Like the functions above; unlike printf(), "%s" also prints std::string arguments.
  template <class... Printed,
            class = typename std::enable_if<(std::is_base_of<std::string, Printed>::value || ...)>::type>
  int writeLog(const char* fmt, const Printed&... printed) const {
    return writeLog(fmt, printable(printed)...);
  }
  template <class... Printed,
            class = typename std::enable_if<(std::is_base_of<std::string, Printed>::value || ...)>::type>
  int writeLog(int log_level, const char* fmt, const Printed&... printed) const {
    return writeLog(log_level, fmt, printable(printed)...);
  }
  /// Like writeLog(), but writes to another file in the working directory. A process's first line empties it.
  /// Returns -1 also if the file cannot be written.
  int writeMyLog(const std::string& filename, const char* fmt, ...) const
      __attribute__((format(printf, 3, 4)));
  int writeMyLog(const std::string& filename, int log_level, const char* fmt, ...) const
      __attribute__((format(printf, 4, 5)));
  /// Highest level (compat: lowest) of which writeLog(level, …) writes lines. Default: 0.
  void setLogLevel(int new_log_level);
  int getLogLevel() const;
  /// Flushes the file after each line, so that nothing is lost in a crash. Off by default.
  void setFlush(bool do_flush = true);
  /// Writes what is buffered to the files now.
  void flush() const { std::fflush(nullptr); }
  /// Has no effect: lines carry no times and no step counts.
  void setLogTimeString(bool /*log_time_string*/ = true) {}
  void setLogStepCount(bool /*log_step_count*/ = true) {}
  /// Makes the current world pass its lines to `sink`, without newlines, instead of writing them to the file.
  /// An empty function makes it write to the file again.
  void setSink(std::function<void(const std::string&)> sink);

 private:
  LogManager();
  static const char* printable(const std::string& printed) { return printed.c_str(); }
  template <class T>
  static typename std::enable_if<!std::is_base_of<std::string, T>::value, const T&>::type printable(
      const T& printed) {
    return printed;
  }
};

}  // namespace df
