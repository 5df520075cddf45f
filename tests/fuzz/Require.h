// Checks conditions that must hold for every input. If one does not, the target crashes, and libFuzzer keeps
// the input.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace naiad::fuzz {

[[noreturn]] inline void broken(const char* what, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: not so: %s\n", file, line, what);
  std::abort();
}

}  // namespace naiad::fuzz

#define REQUIRE(condition) \
  ((condition) ? static_cast<void>(0) : naiad::fuzz::broken(#condition, __FILE__, __LINE__))
