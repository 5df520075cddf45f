// Writes log lines (book, Listing 4.6).
//
// Lines go to the current world's sink; without one, to the file dragonfly.log in the working directory,
// which is opened, and emptied, by the first line that a process writes there.
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

  /// Write one line, formatted as by printf; a newline at its end may be given or left out. Return the
  /// number of characters, or -1 for a bad format.
  int writeLog(const char* fmt, ...) const __attribute__((format(printf, 2, 3)));
  /// The same, if `log_level` is not above the level set (compat: not below it); else return 0.
  int writeLog(int log_level, const char* fmt, ...) const __attribute__((format(printf, 3, 4)));
  /// The same with a std::string among what is to be printed, which printf could not take: "%s" prints it.
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
  /// The same into a file of its own, in the working directory, which the first line empties.
  int writeMyLog(const std::string& filename, const char* fmt, ...) const
      __attribute__((format(printf, 3, 4)));
  int writeMyLog(const std::string& filename, int log_level, const char* fmt, ...) const
      __attribute__((format(printf, 4, 5)));
  /// Default 0: writeLog(1, …) and above write nothing.
  void setLogLevel(int new_log_level);
  int getLogLevel() const;
  /// Flush the file after each line, so that nothing is lost in a crash. Default: no.
  void setFlush(bool do_flush = true);
  /// Lines carry no times and no step counts, whatever is set here.
  void setLogTimeString(bool /*log_time_string*/ = true) {}
  void setLogStepCount(bool /*log_step_count*/ = true) {}
  /// Where the current world's lines go, without newline; an empty function: back to the file.
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
