// attack: strangers attack the real programs while honest players play. docs/bench.md says how.
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "path/suite/Subprocess.h"

namespace bench {

namespace {

const std::vector<std::string> kNames = {"silent4",    "silent6",     "chat_resume", "chat_detached",
                                         "hard_pile",  "held_places", "log_stall",   "log_gone",
                                         "password80", "fork300"};

/// "attack key=value …" of the program, as a Line.
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

void attack(const std::string& name, bool quick) {
  progress("attack: " + name);
  std::vector<std::string> command{std::string(NAIAD_BINARY_DIR) + "/bin/naiad_attack", name};
  if (quick) command.emplace_back("--quick");
  const path::Finished finished = path::runProgram(command);
  std::istringstream lines(finished.output);
  for (std::string line; std::getline(lines, line);) printLine(line);
  if (finished.code != 0)
    Line("attack").add("name", name).addZero("failed", 1).add("because", "not_measured");
}

/// Those that NAIAD_ATTACK_NAMES lists, separated by commas, or all.
std::vector<std::string> wanted() {
  const char* list = std::getenv("NAIAD_ATTACK_NAMES");
  if (list == nullptr) return kNames;
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

const Suite s_suite("attack", "strangers attack the real programs while honest players play",
                    [](const Options& options) {
                      for (const std::string& name : wanted()) attack(name, options.quick);
                    });

}  // namespace

}  // namespace bench
