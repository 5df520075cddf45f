// What libFuzzer calls, for the one file that makes a program a target: it hands the target its input.
#pragma once

#include "Require.h"
#include "Script.h"

namespace naiad::fuzz {

/// Each target defines it.
void tryInput(Script script);

}  // namespace naiad::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  naiad::fuzz::tryInput(naiad::fuzz::Script(data, size));
  return 0;
}
