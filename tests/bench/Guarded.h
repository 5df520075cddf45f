// The frame of a program's main().
#pragma once

#include <cstdio>
#include <exception>

namespace bench {

/// Returns the exit code that `work` returns. If it throws, prints why on stderr and returns 1.
template <class Work>
int guarded(const char* program, Work work) {
  try {
    return work();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
}

}  // namespace bench
