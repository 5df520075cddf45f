// dfctl, as it is.
#pragma once

#include <string>
#include <utility>

#include "tests/support/RunProgram.h"

namespace naiad::test {

/// Its exit code, and what it says, on standard error as well.
inline std::pair<int, std::string> runCtl(const std::string& arguments) {
  return runProgram(std::string(NAIAD_BINARY_DIR) + "/dfctl " + arguments + " 2>&1 </dev/null");
}

}  // namespace naiad::test
