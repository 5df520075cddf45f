// Log lines with the time of day, to a file or stderr.
#pragma once

#include <fstream>
#include <functional>
#include <string>

namespace naiad {

/// Where log lines go.
using LogLine = std::function<void(const std::string& line)>;

class LineLog {
 public:
  /// Append to this file; empty: stderr. Throws std::runtime_error if it cannot be written.
  explicit LineLog(const std::string& path);
  void operator()(const std::string& line);

 private:
  std::ofstream m_file;
};

}  // namespace naiad
