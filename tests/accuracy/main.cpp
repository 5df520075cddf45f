// naiad_lab: runs problems with every method and number of sub-steps, prints a line per point and metric, and
// writes the data of the report.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "Guarded.h"
#include "Measurement.h"
#include "Records.h"
#include "ResultLine.h"
#include "shared/options/Options.h"

namespace {

constexpr const char* kUsage =
    "usage: naiad_lab [--quick] [--method NAME]... [--substeps N]... [--runs N] [--output DIR] [PROBLEM...]\n"
    "       naiad_lab --list\n"
    "deploy/lab --help explains the arguments and the exit codes. Without --output, no files are written.\n";

constexpr int kRuns = 5;
constexpr int kFewestRuns = 2;
constexpr int kCrowdRuns = 3;  // runs of cases with thousands of bodies
constexpr int kMaxCpuSeconds = 120;
constexpr int kMaxShorterTicks = 16;  // limit of ticks per tick in the product's curves

struct Options {
  bool quick = false;
  int runs = 0;  // 0: as many as the case needs
  std::string output;
  std::vector<const lab::Method*> methods;
  std::vector<int> substeps;  // empty: all
  std::vector<lab::Problem> problems;
};

int usage(std::FILE* out, int code) {
  std::fputs(kUsage, out);
  return code;
}

int list() {
  std::puts("problems:");
  for (const lab::Problem& problem : lab::Problem::all()) {
    std::printf("  %-14s %s\n", problem.id.c_str(), problem.name.c_str());
  }
  std::puts("methods:");
  for (const lab::Method* method : lab::Method::all()) {
    std::printf("  %-14s %s %s\n", method->name.c_str(), method->label.c_str(), method->version.c_str());
  }
  return 0;
}

std::vector<int> substepCounts(const Options& options, const lab::Problem& problem, const lab::Case& its_case,
                               const lab::Method& method) {
  if (its_case.is_crowd && !method.isProduct() && method.kind != lab::Method::Kind::PEER) return {};
  const bool is_curve = problem.kind == lab::Problem::Kind::MAP || its_case.draws_levels;
  if (method.own_substeps > 0 && !is_curve) return {method.own_substeps};
  std::vector<int> counts;
  for (const int count : {1, 2, 4, 8, 16, 32, 64}) {
    const bool quick = count == 1 || count == 4 || count == 16;
    const std::vector<int>& asked = options.substeps;
    // Even if it is not asked for, a level is measured at the number of sub-steps at which it is judged.
    const bool is_asked = asked.empty() || std::find(asked.begin(), asked.end(), count) != asked.end() ||
                          (problem.kind == lab::Problem::Kind::DIAGRAM && count == method.own_substeps);
    if (count < method.own_substeps) continue;  // ticks can only get shorter, not longer
    if (problem.kind == lab::Problem::Kind::DIAGRAM && method.isProduct() && count > kMaxShorterTicks)
      continue;
    if (is_asked && count <= its_case.most_substeps && (quick || !options.quick)) counts.push_back(count);
  }
  return counts;
}

// One point of a problem.
struct Run {
  const lab::Case* its_case;
  const lab::Method* method;
  int substeps;
  lab::Measurement measurement;
};

std::vector<Run> runsOf(const Options& options, const lab::Problem& problem,
                        const std::vector<lab::Case>& cases) {
  std::vector<Run> runs;
  for (const lab::Case& its_case : cases) {
    if (its_case.long_run && options.quick) continue;
    for (const lab::Method* method : options.methods) {
      for (const int substeps : substepCounts(options, problem, its_case, *method)) {
        runs.push_back({&its_case, method, substeps, {}});
      }
    }
  }
  return runs;
}

const Run* findRun(const std::vector<Run>& runs, const std::string& case_name, const std::string& method,
                   int substeps) {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const Run& run) {
    return run.its_case->name == case_name && run.method->name == method && run.substeps == substeps &&
           run.measurement.expressed;
  });
  return found == runs.end() ? nullptr : &*found;
}

// Returns the run's time in units of the bound; NaN if the unit was not measured.
double partOf(const lab::CpuBound& bound, const Run& run, const std::vector<Run>& runs) {
  const double own = run.measurement.cpu.median;
  if (bound.is_of_later) return run.measurement.cpu.first_part;
  if (bound.unit_us > 0) return own / bound.unit_us;
  const Run* compared = bound.method.empty()
                            ? findRun(runs, bound.of_case, run.method->name, run.substeps)
                            : findRun(runs, run.its_case->name, bound.method, bound.substeps);
  return compared == nullptr ? std::nan("") : own / compared->measurement.cpu.median;
}

// Records the times that are judged relative to other times. Call when all runs are measured.
void compareTimes(const lab::Problem& problem, const std::vector<Run>& runs, lab::Records& records) {
  for (const Run& run : runs) {
    if (!run.measurement.expressed) continue;
    for (const lab::CpuBound& bound : run.its_case->cpu_bounds) {
      const double part = partOf(bound, run, runs);
      if (std::isnan(part)) continue;
      records.add(problem, *run.its_case, bound, *run.method, run.substeps, run.measurement, part);
    }
  }
}

void run(const Options& options, lab::Records& records) {
  for (const lab::Problem& problem : options.problems) {
    bench::progress(problem.id + " " + problem.name);
    const std::vector<lab::Case> cases = problem.make();
    records.describe(problem, cases);
    std::vector<Run> runs = runsOf(options, problem, cases);
    for (Run& run : runs) {
      const int usual = run.its_case->is_crowd ? kCrowdRuns : kRuns;
      run.measurement = lab::measureApart(*run.its_case, *run.method, run.substeps,
                                          options.runs > 0 ? options.runs : usual, kMaxCpuSeconds);
      if (!run.measurement.expressed) continue;
      records.add(problem, *run.its_case, *run.method, run.substeps, run.measurement);
    }
    compareTimes(problem, runs, records);
  }
}

// Appends the element that has this name to `found`. Prints a message and returns false if no element has it.
template <class Found>
bool addNamed(const char* kind, const std::string& name, const std::map<std::string, Found>& all,
              std::vector<Found>& found) {
  const auto it = all.find(name);
  if (it != all.end()) {
    found.push_back(it->second);
    return true;
  }
  std::vector<std::string> names{"--help",  "--list", "--method",  "--output",
                                 "--quick", "--runs", "--substeps"};
  for (const auto& [other, element] : all) names.push_back(other);
  const std::string near = naiad::nearestName(name, names);
  std::fprintf(stderr, "naiad_lab: there is no %s '%s'%s\n", kind, name.c_str(),
               near.empty() ? "" : ("; '" + near + "' is the nearest").c_str());
  return false;
}

// Parses the arguments. For an invalid one, prints a message and returns false.
bool read(const std::vector<std::string>& arguments, Options& options) {
  std::map<std::string, const lab::Method*> methods;
  for (const lab::Method* method : lab::Method::all()) methods[method->name] = method;
  std::map<std::string, lab::Problem> problems;
  for (const lab::Problem& problem : lab::Problem::all()) {
    problems[problem.id] = problems[problem.name] = problem;
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    const bool has_value = i + 1 < arguments.size();
    if (argument == "--quick") {
      options.quick = true;
    } else if (argument == "--output" && has_value) {
      options.output = arguments[++i];
    } else if (argument == "--runs" && has_value) {
      options.runs = std::max(std::atoi(arguments[++i].c_str()), kFewestRuns);
    } else if (argument == "--substeps" && has_value) {
      options.substeps.push_back(std::atoi(arguments[++i].c_str()));
    } else if (argument == "--method" && has_value) {
      if (!addNamed("method", arguments[++i], methods, options.methods)) return false;
    } else if (!addNamed("problem", argument, problems, options.problems)) {
      return false;
    }
  }
  if (options.methods.empty()) options.methods = lab::Method::all();
  if (options.problems.empty()) options.problems = lab::Problem::all();
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  for (const std::string& argument : arguments) {
    if (argument == "-h" || argument == "--help") return usage(stdout, 0);
    if (argument == "--list") return list();
  }
  Options options;
  if (!read(arguments, options)) return usage(stderr, 2);
  return bench::guarded("naiad_lab", [&] {
    bench::reserveStdout();
    lab::Records records(options.output, options.runs);
    run(options, records);
    return records.allMet() ? 0 : 1;
  });
}
