// Log lines for a thread that must not wait: one that ends a server whose game may hold the log's lock.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "shared/program/LineLog.h"

namespace naiad {

/// Passes lines on, in order, on a thread of its own, which is there before it is needed.
class SideLog {
 public:
  explicit SideLog(LogLine log);
  /// Waits for all lines, however long they take.
  ~SideLog();
  SideLog(const SideLog&) = delete;
  SideLog& operator=(const SideLog&) = delete;

  /// Does not wait for the log. Any thread.
  void operator()(const std::string& line);
  /// Wait until all lines are passed on, or for so long. Any thread.
  void waitUntilLogged(std::chrono::milliseconds most);

 private:
  void run();

  LogLine m_log;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::deque<std::string> m_lines;  ///< the first one is being passed on
  bool m_stopping = false;
  std::thread m_thread;  ///< last: it uses the others
};

}  // namespace naiad
