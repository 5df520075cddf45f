#include "Suite.h"

#include <cstdlib>
#include <sstream>

#include "ResultLine.h"
#include "Worker.h"

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
