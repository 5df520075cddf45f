// Waiting for what other threads and processes do.
#pragma once

#include <chrono>
#include <thread>

namespace naiad::test {

/// Look again and again until it holds. False: it does not within a minute.
template <class Condition>
bool waitUntil(Condition holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // before it is looked at again
  }
  return true;
}

}  // namespace naiad::test
