// naiad_bench: runs the named suites, or all, and prints one line per measurement.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "Worker.h"
#include "shared/options/Options.h"

namespace bench {
namespace {

// Created when the first suite registers.
std::map<std::string, const Suite*>& registry() {
  static std::map<std::string, const Suite*> s_suites;
  return s_suites;
}

/// Prints "suite key=value …" as a Line.
void printLine(const std::string& text) {
  std::istringstream words(text);
  std::string suite;
  words >> suite;
  Line line(suite);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = word.substr(0, equals);
    const std::string value = word.substr(equals + 1);
    key == "failed" ? line.addZero(key, std::stoll(value)) : line.add(key, value);
  }
}

}  // namespace

Suite::Suite(const std::string& name, const std::string& summary, Run its_run)
    : m_summary(summary), m_run(its_run) {
  registry()[name] = this;
}

const std::map<std::string, const Suite*>& Suite::all() {
  return registry();
}

std::vector<std::string> namesFrom(const char* variable, const std::vector<std::string>& all) {
  const char* list = std::getenv(variable);
  if (list == nullptr) return all;
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

int printLinesOf(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> command{std::string(NAIAD_BINARY_DIR) + "/bin/" + program};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const Worker::End finished = runProgram(command);
  std::istringstream lines(finished.output);
  for (std::string line; std::getline(lines, line);) printLine(line);
  return finished.code;
}

}  // namespace bench

namespace {

constexpr const char* kUsage =
    "usage: naiad_bench [--quick] [SUITE...]\n"
    "       naiad_bench --list\n"
    "deploy/bench --help explains the arguments and the exit codes.\n";

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
