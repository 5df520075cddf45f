// A bar on stderr, if that is a terminal.
#pragma once

#include <string>

namespace lab {

class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `part` of the whole is done, from 0 to 1; `what` is being done now.
  void show(double part, const std::string& what);

 private:
  bool m_shown;
};

}  // namespace lab
