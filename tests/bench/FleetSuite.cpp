// fleet: ten servers, a bus and a directory; servers and bus are killed while players play. docs/bench.md
// describes it.
#include "ResultLine.h"
#include "Suite.h"

namespace bench {
namespace {

const std::vector<std::string> kQuick = {"40", "3", "5", "30", "4"};
const std::vector<std::string> kWhole = {"1000", "20", "60", "10"};

const Suite s_suite("fleet",
                    "ten servers are killed at random while players of a directory play, and their bus",
                    [](const Options& options) {
                      progress("fleet");
                      const Ending ending = printLinesOf("naiad_fleet", options.quick ? kQuick : kWhole);
                      if (ending.code != 0) Line("fleet").addZero("failed", 1);
                    });

}  // namespace
}  // namespace bench
