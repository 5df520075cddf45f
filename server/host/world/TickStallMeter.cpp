#include "host/world/TickStallMeter.h"

#include <time.h>

#include <algorithm>
#include <string>

#include "host/world/Descendants.h"

namespace naiad {

namespace {

// A process that waits for a disk, or for memory that was paged out, counts as running.
ProcessRunState::Doing doingOf(char state) {
  if (state == 't') return ProcessRunState::kDebugged;
  if (state == 'T') return ProcessRunState::kStopped;
  return state == 'S' ? ProcessRunState::kWaits : ProcessRunState::kRuns;
}

std::optional<std::chrono::nanoseconds> cpuTimeOf(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (process <= 0 || clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0)
    return std::nullopt;
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

std::optional<ProcessRunState> readProcessRunState(pid_t process) {
  const auto cpu = cpuTimeOf(process);
  const std::string fields = cpu ? statFieldsOf(process) : "";
  if (fields.empty()) return std::nullopt;
  return ProcessRunState{doingOf(fields.front()), *cpu};
}

void SlowTickDetector::beginTick(pid_t process) {
  if (!m_reported) m_cpu = cpuTimeOf(process).value_or(Nanos(0)).count();
}

std::string SlowTickDetector::check(pid_t process, std::uint64_t tick, Nanos passed, Nanos frame,
                                    std::string_view activity) {
  if (m_reported || passed < frame || tick <= 1 || activity.empty()) return {};
  const auto look = readProcessRunState(process);
  if (!look || (look->doing != ProcessRunState::kWaits && look->cpu - Nanos(m_cpu) < frame / 2)) return {};
  m_reported = true;
  return "tick " + std::to_string(tick) + " takes longer than the frame time of " +
         std::to_string(std::chrono::duration_cast<std::chrono::milliseconds>(frame).count()) + " ms" +
         std::string(activity) + ": the game is not smooth (reported once)";
}

void TickStallMeter::count(Nanos passed, const std::optional<ProcessRunState>& look) {
  if (!look) {
    m_counted += passed;
    return;
  }
  const Nanos computed = m_cpu ? std::clamp(look->cpu - *m_cpu, Nanos(0), passed) : Nanos(0);
  m_cpu = look->cpu;
  const bool is_stopped =
      look->doing == ProcessRunState::kStopped || look->doing == ProcessRunState::kDebugged;
  m_stopped = is_stopped ? m_stopped + passed : Nanos(0);
  if (look->doing == ProcessRunState::kDebugged) return;
  const Nanos own = look->doing == ProcessRunState::kWaits ? passed : computed;
  m_own += own;
  m_counted += std::max(own, passed / kStarvedPart);
}

}  // namespace naiad
