// A bar on stderr, if that is a terminal.
#pragma once

#include <string>

namespace lab {

class Progress {
 public:
  explicit Progress(int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// One more is about to begin.
  void next(const std::string& what);

 private:
  int m_total;
  int m_done = 0;
  bool m_shown;
};

}  // namespace lab
