#include "host/world/TickStallMeter.h"

#include <time.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace naiad {

namespace {

/// Returns the state letter of /proc/PID/stat. It follows the program's name, which may contain anything.
char stateOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  return name_end != std::string::npos && name_end + 2 < line.size() ? line[name_end + 2] : '\0';
}

// A process that waits for a disk, or for memory that was paged out, counts as running.
ProcessRunState::Doing doingOf(char state) {
  if (state == 't') return ProcessRunState::kDebugged;
  if (state == 'T') return ProcessRunState::kStopped;
  return state == 'S' ? ProcessRunState::kWaits : ProcessRunState::kRuns;
}

}  // namespace

std::optional<ProcessRunState> readProcessRunState(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (process <= 0 || clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0)
    return std::nullopt;
  const char state = stateOf(process);
  if (state == '\0') return std::nullopt;
  return ProcessRunState{doingOf(state),
                         std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec)};
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
