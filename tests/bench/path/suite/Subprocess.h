// Runs programs and reads their output.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace bench::path {

struct Finished {
  int code = 0;        ///< exit code, or 128 + the signal that ended it
  std::string output;  ///< its stdout
};

/// Runs a command to its end. Its stderr goes to ours. Throws std::runtime_error if it cannot be started.
Finished runProgram(const std::vector<std::string>& command);

/// Returns the values of a line "word key=value key=value", by key.
std::map<std::string, double> figuresOf(const std::string& line);

}  // namespace bench::path
