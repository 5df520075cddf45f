#include "Measurement.h"

#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "ElapsedTime.h"
#include "Percentile.h"

namespace lab {
namespace {

// Runs that take less are repeated on fresh copies of the scene until they take this long together, because
// reading the clock takes a quarter of a microsecond.
constexpr double kShortestRunNs = 400000;
constexpr int kMaxCopies = 256;

// Runs that take more are only timed tick by tick, because reading the clock for each tick is then
// negligible.
constexpr double kLongRunNs = 1e8;

double runNs(const Case& its_case, const Method& method, int substeps, int copies) {
  const Scene scene = paceOf(method, its_case.scene, substeps).scene;
  std::vector<SimulationPtr> simulations;
  for (int i = 0; i < copies; ++i) simulations.push_back(method.build(scene));
  const double start = bench::cpuNanoseconds();
  for (const SimulationPtr& simulation : simulations) {
    for (int tick = 0; tick < scene.ticks; ++tick) simulation->step(scene.tick, substeps);
  }
  return (bench::cpuNanoseconds() - start) / copies;
}

struct TickTimes {
  std::vector<double> us;       // time of each tick, in microseconds
  std::vector<double> allowed;  // limit of each tick; empty: not available

  double total() const { return std::accumulate(us.begin(), us.end(), 0.0); }
};

TickTimes timeTicks(const Case& its_case, const Method& method, int substeps) {
  const ScenePace pace = paceOf(method, its_case.scene, substeps);
  const SimulationPtr simulation = method.build(pace.scene);
  const auto bodies = static_cast<double>(pace.scene.bodies.size());
  const auto joints = static_cast<double>(pace.scene.joints.size());
  TickTimes times;
  std::optional<Work> before = simulation->work();
  for (int tick = 0; tick < its_case.scene.ticks; ++tick) {
    const double begin = bench::cpuNanoseconds();
    for (int i = 0; i < pace.each; ++i) simulation->step(pace.scene.tick, substeps);
    times.us.push_back((bench::cpuNanoseconds() - begin) * 1e-3);
    if (!before) continue;
    const Work now = *simulation->work();
    times.allowed.push_back(its_case.tick_bound.allowedUs(bodies, now.contacts - before->contacts, joints,
                                                          now.impacts - before->impacts));
    before = now;
  }
  return times;
}

// Takes each tick's minimum over all runs: their work is equal, and a busy machine only adds time.
void judgeTicks(const std::vector<TickTimes>& runs, CpuTime& cpu) {
  const std::vector<double>& allowed = runs[0].allowed;
  std::vector<double> us = runs[0].us;
  for (const TickTimes& run : runs) {
    for (std::size_t i = 0; i < us.size(); ++i) us[i] = std::min(us[i], run.us[i]);
  }
  cpu.worst = *std::max_element(us.begin(), us.end());
  if (us.size() > 1) cpu.first_part = us[0] / bench::percentile<double>({us.begin() + 1, us.end()}, 50);
  if (allowed.empty()) return;
  cpu.worst_part = 0;
  for (std::size_t i = 0; i < us.size(); ++i) cpu.worst_part = std::max(cpu.worst_part, us[i] / allowed[i]);
}

CpuTime timeRuns(const Case& its_case, const Method& method, int substeps, int runs) {
  std::vector<TickTimes> by_tick;
  for (int i = 0; i < runs; ++i) by_tick.push_back(timeTicks(its_case, method, substeps));
  std::vector<double> totals;
  if (by_tick[0].total() * 1e3 >= kLongRunNs) {
    for (const TickTimes& run : by_tick) totals.push_back(run.total());
  } else {  // the runs timed tick by tick were the warm-up
    const double first = runNs(its_case, method, substeps, 1);
    const int copies = std::clamp(static_cast<int>(kShortestRunNs / std::max(first, 1.0)), 1, kMaxCopies);
    for (int i = 0; i < runs; ++i) totals.push_back(runNs(its_case, method, substeps, copies) * 1e-3);
  }
  const double ticks = its_case.scene.ticks;
  CpuTime cpu{bench::percentile(totals, 50) / ticks, bench::percentile(totals, 0) / ticks,
              bench::percentile(totals, 100) / ticks};
  judgeTicks(by_tick, cpu);
  return cpu;
}

constexpr CpuTime unknownTime() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
}

constexpr std::size_t kReasonSize = 64;
constexpr std::size_t kMaxMetrics = 8;

// The results of a child process: the errors as soon as they are known, then the times.
struct Results {
  bool judged = false;
  bool timed = false;
  bool expressed = true;
  char reason[kReasonSize] = {};
  double errors[kMaxMetrics] = {};
  CpuTime cpu;
};

void release(Results* p_results) {
  munmap(p_results, sizeof(Results));
}

// Returns results in memory that this process shares with its children.
std::unique_ptr<Results, decltype(&release)> sharedResults() {
  void* memory = mmap(nullptr, sizeof(Results), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
  return {new (memory) Results, &release};
}

[[noreturn]] void child(Results& results, const Case& its_case, const Method& method, int substeps, int runs,
                        int most_seconds) {
  const rlimit limit{static_cast<rlim_t>(most_seconds), static_cast<rlim_t>(most_seconds)};
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CPU, &limit);
  setrlimit(RLIMIT_CORE, &no_core);
  if (std::freopen("/dev/null", "w", stderr) == nullptr) _exit(1);  // hides a library's messages on a crash
  const Measurement measurement = judge(its_case, method, substeps);
  results.expressed = measurement.expressed;
  std::strncpy(results.reason, measurement.reason.c_str(), kReasonSize - 1);
  std::copy(measurement.errors.begin(), measurement.errors.end(), results.errors);
  results.judged = true;
  if (measurement.expressed) {
    results.cpu = method.is_timed ? timeRuns(its_case, method, substeps, runs) : unknownTime();
    results.timed = true;
  }
  _exit(0);
}

std::string deathOf(int status) {
  if (!WIFSIGNALED(status)) return "ended early";
  return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL
             ? "took too long"
             : "crashed by signal " + std::to_string(WTERMSIG(status));
}

}  // namespace

Measurement judge(const Case& its_case, const Method& method, int substeps) {
  Measurement measurement;
  measurement.errors.assign(its_case.metrics.size(), std::numeric_limits<double>::infinity());
  try {
    measurement.errors = its_case.judge(Trial(method, substeps));
    if (measurement.errors.size() != its_case.metrics.size()) throw std::logic_error("one error per metric");
  } catch (const Inexpressible&) {
    measurement.expressed = false;
  } catch (const Failure& failure) {
    measurement.reason = failure.what();
  }
  for (double& error : measurement.errors) {
    if (!std::isnan(error)) continue;
    error = std::numeric_limits<double>::infinity();
    if (measurement.reason.empty()) measurement.reason = "not a number";
  }
  return measurement;
}

Measurement measureApart(const Case& its_case, const Method& method, int substeps, int runs,
                         int most_seconds) {
  if (its_case.metrics.size() > kMaxMetrics) throw std::logic_error("too many metrics");
  const auto results = sharedResults();
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error("no process");
  if (pid == 0) child(*results, its_case, method, substeps, runs, most_seconds);
  int status = 0;
  waitpid(pid, &status, 0);

  Measurement measurement;
  measurement.expressed = results->expressed;
  measurement.cpu = results->timed ? results->cpu : unknownTime();
  if (!results->judged) {
    measurement.errors.assign(its_case.metrics.size(), std::numeric_limits<double>::infinity());
    measurement.reason = deathOf(status);
    return measurement;
  }
  measurement.errors.assign(results->errors, results->errors + its_case.metrics.size());
  measurement.reason = results->reason;
  if (measurement.expressed && !results->timed && measurement.reason.empty()) {
    measurement.reason = "not timed: " + deathOf(status);
  }
  return measurement;
}

}  // namespace lab
