#include "host/metrics/HostHealth.h"

#include <algorithm>
#include <cstdio>

namespace naiad {

const char* nameOf(Stage stage) {
  switch (stage) {
    case Stage::kIdle:
      return "idle";
    case Stage::kReceive:
      return "receive";
    case Stage::kSessions:
      return "sessions";
    case Stage::kInputs:
      return "inputs";
    case Stage::kWorld:
      return "world";
    case Stage::kPublish:
      return "publish";
    case Stage::kSnapshots:
      return "snapshots";
    case Stage::kBroadcasts:
      return "broadcasts";
    case Stage::kFlush:
      return "flush";
  }
  return "unknown";
}

void HostHealth::begin(std::chrono::nanoseconds tick_length, Clock::time_point now) {
  m_hang_time = std::max(kMinHangTime, kHangTicks * tick_length).count();
  m_began = now.time_since_epoch().count();
  m_phase = Phase::kRunning;
}

void HostHealth::beginDrain(bool ticks) {
  m_phase = ticks ? Phase::kDraining : Phase::kEnding;
}

// Always good while the host loads its game, or flushes its last bytes at the end: then it does not tick.
HostHealth::Result HostHealth::health(Clock::time_point now) const {
  const Phase phase = m_phase;
  if (phase == Phase::kStarting) return {true, "starting"};
  if (phase == Phase::kEnding) return {true, "ending"};
  const Clock::time_point start{Clock::duration(m_began.load(std::memory_order_relaxed))};
  const auto since = now - std::max(start, m_stages.tickBegan());
  if (since <= std::chrono::nanoseconds(m_hang_time.load(std::memory_order_relaxed))) return {true, "ok"};
  char text[128];
  std::snprintf(text, sizeof text, "no tick has begun for %.1f s; in tick %llu, stage %s",
                std::chrono::duration<double>(since).count(),
                static_cast<unsigned long long>(m_stages.tick()), nameOf(m_stages.current()));
  return {false, text};
}

HostHealth::Result HostHealth::readiness(Clock::time_point now) const {
  switch (m_phase) {
    case Phase::kStarting:
      return {false, "starting"};
    case Phase::kDraining:
    case Phase::kEnding:
      return {false, "shutting down: no new players"};
    case Phase::kRunning:
      break;
  }
  if (Result verdict = health(now); !verdict.is_good) return verdict;
  if (m_full.load(std::memory_order_relaxed)) return {false, "full"};
  return {true, "ok"};
}

}  // namespace naiad
