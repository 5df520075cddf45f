// Sent once per tick, unless the game is paused, before anything else happens (book, Listing 4.53).
#pragma once

#include "Event.h"

namespace df {

/// Register interest in this to be called in each tick, 30 times a second by default.
inline const EventType STEP_EVENT("df-step");

class EventStep : public Event {
 public:
  /// Makes a step event with count 0.
  EventStep() : EventStep(0) {}
  /// Makes the step event of tick number `step_count`.
  explicit EventStep(int step_count) : m_step_count(step_count) { setType(STEP_EVENT); }

  /// Number of ticks since the world began, including this one: 1 in the first tick (compat: 0).
  void setStepCount(int step_count) { m_step_count = step_count; }
  int getStepCount() const { return m_step_count; }

 private:
  int m_step_count;
};

}  // namespace df
