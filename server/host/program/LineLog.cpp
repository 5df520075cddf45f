#include "host/program/LineLog.h"

#include <ctime>
#include <iostream>
#include <stdexcept>

namespace naiad {

LineLog::LineLog(const std::string& path) {
  if (path.empty()) return;
  m_file.open(path, std::ios::app);
  if (!m_file) throw std::runtime_error("The log file " + path + " cannot be written.");
}

void LineLog::operator()(const std::string& line) {
  const std::time_t now = std::time(nullptr);
  char time[32];
  std::strftime(time, sizeof time, "%Y-%m-%d %H:%M:%S ", std::localtime(&now));
  (m_file.is_open() ? m_file : std::cerr) << time << line << std::endl;
}

}  // namespace naiad
