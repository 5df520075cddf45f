// rooms: sixteen rooms of one server, of which three fail. docs/bench.md says how.
#include <sstream>
#include <string>

#include "ResultLine.h"
#include "Suite.h"
#include "path/suite/Subprocess.h"

namespace bench {

namespace {

const Suite s_suite("rooms", "players of rooms notice nothing of others that burn a core, crash and hang",
                    [](const Options& options) {
                      progress("rooms");
                      const path::Finished finished = path::runProgram(
                          {std::string(NAIAD_BINARY_DIR) + "/bin/naiad_rooms", options.quick ? "10" : "120"});
                      std::istringstream words(finished.output);
                      std::string suite;
                      words >> suite;
                      Line line("rooms");
                      for (std::string word; words >> word;) {
                        const std::size_t equals = word.find('=');
                        if (equals != std::string::npos)
                          line.add(word.substr(0, equals), word.substr(equals + 1));
                      }
                      line.addZero("failed", finished.code != 0 ? 1 : 0);
                    });

}  // namespace

}  // namespace bench
