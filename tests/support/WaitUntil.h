// Waits for actions of other threads and processes.
#pragma once

#include <chrono>
#include <thread>

namespace naiad::test {

/// Checks the condition repeatedly. False if it does not hold within a minute.
template <class Condition>
bool waitUntil(Condition holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // pause between two checks
  }
  return true;
}

}  // namespace naiad::test
