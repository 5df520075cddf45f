// The log of a world: writes its lines, and counts the calls that were refused.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <utility>

namespace df {

struct ActivityPage;

class WorldLog {
 public:
  using Sink = std::function<void(const std::string& line)>;

  /// Sets the function that receives the lines. Without one, lines go to a file (LogManager.h).
  void setSink(Sink sink) { m_sink = std::move(sink); }
  /// Sets the name of the file for lines without a sink. Not owned; null for dragonfly.log.
  void setFile(const std::string* p_name) { m_p_file = p_name; }
  /// Copies further lines to this page, for the report of a crash. Not owned; null for none.
  void setPage(ActivityPage* p_page) { m_p_page = p_page; }
  /// Lines of writeLog(level, …) with a level above this (compat: below) are dropped.
  void setLevel(int level) { m_level = level; }
  int level() const { return m_level; }
  void setFlush(bool flush) { m_flush = flush; }
  bool flush() const { return m_flush; }

  /// Writes one line, without a newline at its end.
  void write(const std::string& line) const;
  /// Writes the line, unless writeOnce() has written it before. After 500 different lines, writes none.
  void writeOnce(const std::string& line);
  /// Like writeOnce(), but only crash reports show the line.
  void addActivityLineOnce(const std::string& line);
  /// Counts a refused call. For the first one of each name and type of Object, writes a line with the valid
  /// values. Returns -1.
  int refuse(const std::string& type, const char* what);
  /// Returns the number of refused calls.
  std::uint64_t refusals() const { return m_refusals; }
  /// Resets refusals(), and lets writeOnce(), addActivityLineOnce() and refuse() write all lines again.
  void clear();

 private:
  bool isNew(const std::string& line);

  Sink m_sink;
  const std::string* m_p_file = nullptr;
  ActivityPage* m_p_page = nullptr;
  std::set<std::string> m_once;
  std::uint64_t m_refusals = 0;
  int m_level = 0;
  bool m_flush = false;
};

}  // namespace df
