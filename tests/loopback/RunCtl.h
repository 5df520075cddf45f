// Runs the real dfctl.
#pragma once

#include <string>
#include <utility>

#include "tests/support/RunProgram.h"

namespace naiad::test {

/// Returns its exit code and its output, standard error included.
inline std::pair<int, std::string> runCtl(const std::string& arguments) {
  return runProgram(std::string(NAIAD_BINARY_DIR) + "/dfctl " + arguments + " 2>&1 </dev/null");
}

}  // namespace naiad::test
