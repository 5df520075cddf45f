// Runs the real dfctl.
#pragma once

#include <string>
#include <utility>

#include "tests/support/RunProgram.h"

namespace naiad::test {

/// Runs dfctl with these arguments. Returns its exit code and its output, including standard error.
inline std::pair<int, std::string> runCtl(const std::string& arguments) {
  return runProgram(std::string(NAIAD_BINARY_DIR) + "/dfctl " + arguments + " 2>&1 </dev/null");
}

}  // namespace naiad::test
