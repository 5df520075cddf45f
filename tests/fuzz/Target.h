// Included by the main source file of each target. Passes libFuzzer's input to tryInput().
#pragma once

#include "Require.h"
#include "Script.h"

namespace naiad::fuzz {

/// Tests one input. Each target defines this function.
void tryInput(Script script);

}  // namespace naiad::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  naiad::fuzz::tryInput(naiad::fuzz::Script(data, size));
  return 0;
}
