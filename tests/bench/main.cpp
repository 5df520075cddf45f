// naiad_bench: runs the named suites, or all, and prints one line per measurement.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "shared/options/Options.h"

namespace {

constexpr const char* kUsage =
    "usage: naiad_bench [--quick] [SUITE...]\n"
    "       naiad_bench --list\n"
    "\n"
    "  SUITE    suite to run (default: all)\n"
    "  --quick  run only small worlds, to check that the suites work\n"
    "  --list   list the suites\n"
    "\n"
    "Exit codes: 0 measured, 1 engines disagree, are wrong, or a suite failed, 2 wrong usage.\n";

int usage(std::FILE* out, int code) {
  std::fputs(kUsage, out);
  return code;
}

int list() {
  for (const auto& [name, suite] : bench::Suite::all()) {
    std::printf("%-10s %s\n", name.c_str(), suite->summary().c_str());
  }
  return 0;
}

void sayUnknown(const std::string& name) {
  std::vector<std::string> names{"--help", "--list", "--quick"};
  for (const auto& [suite, its] : bench::Suite::all()) names.push_back(suite);
  const std::string near = naiad::nearestName(name, names);
  std::fprintf(stderr, "naiad_bench: there is no suite '%s'%s\n", name.c_str(),
               near.empty() ? "" : ("; '" + near + "' is the nearest").c_str());
}

int run(const std::vector<std::string>& names, const bench::Options& options) {
  for (const std::string& name : names) {
    try {
      bench::Suite::all().at(name)->run(options);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "naiad_bench: %s: %s\n", name.c_str(), e.what());
      return 1;
    }
  }
  if (bench::allEqual()) return 0;
  std::fputs(
      "naiad_bench: something that should be right or the same is not: see equal=0, mismatches, through, "
      "ghosts, failed\n",
      stderr);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  bench::Options options;
  std::vector<std::string> names;
  for (const std::string& argument : std::vector<std::string>(argv + 1, argv + argc)) {
    if (argument == "-h" || argument == "--help") return usage(stdout, 0);
    if (argument == "--list") return list();
    if (argument == "--quick") {
      options.quick = true;
    } else if (bench::Suite::all().contains(argument)) {
      names.push_back(argument);
    } else {
      sayUnknown(argument);
      return usage(stderr, 2);
    }
  }
  if (names.empty()) {
    for (const auto& [name, suite] : bench::Suite::all()) names.push_back(name);
  }
  bench::reserveStdout();
  return run(names, options);
}
