#include "engine/managers/Clock.h"
#include "engine/prelude/Sfml.h"

namespace sf {

namespace {

// Returns the game time since the first call, in microseconds. All clocks share it.
long elapsed() {
  static const df::Clock kBegun;
  return kBegun.split();
}

}  // namespace

Clock::Clock() : m_start(elapsed()) {}

Time Clock::getElapsedTime() const {
  return Time(elapsed() - m_start);
}

Time Clock::restart() {
  const Time before = getElapsedTime();
  m_start = elapsed();
  return before;
}

}  // namespace sf
