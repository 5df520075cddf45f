// fleet: ten servers, a bus and a directory; servers and bus are killed while players play. docs/bench.md
// says how.
#include <sstream>
#include <string>
#include <vector>

#include "ResultLine.h"
#include "Suite.h"
#include "path/suite/Subprocess.h"

namespace bench {

namespace {

void runFleet(const std::vector<std::string>& words) {
  std::vector<std::string> command = {std::string(NAIAD_BINARY_DIR) + "/bin/naiad_fleet"};
  command.insert(command.end(), words.begin(), words.end());
  const path::Finished finished = path::runProgram(command);
  std::istringstream output(finished.output);
  std::string suite;
  output >> suite;
  Line line("fleet");
  for (std::string word; output >> word;) {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals);
    if (equals != std::string::npos && key != "failed") line.add(key, word.substr(equals + 1));
  }
  line.addZero("failed", finished.code != 0 ? 1 : 0);
}

const Suite s_suite("fleet",
                    "ten servers are killed at random while players of a directory play, and their bus",
                    [](const Options& options) {
                      progress("fleet");
                      runFleet(options.quick ? std::vector<std::string>{"40", "3", "5", "30", "4"}
                                             : std::vector<std::string>{"1000", "20", "60", "10"});
                    });

}  // namespace

}  // namespace bench
