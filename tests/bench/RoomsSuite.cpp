// rooms: sixteen rooms of one server, three of which fail. docs/bench.md describes it.
#include "ResultLine.h"
#include "Suite.h"

namespace bench {
namespace {

const Suite s_suite("rooms", "players of rooms notice nothing of others that burn a core, crash and hang",
                    [](const Options& options) {
                      progress("rooms");
                      const Ending ending = printLinesOf("naiad_rooms", {options.quick ? "10" : "120"});
                      if (ending.code != 0) Line("rooms").addZero("failed", 1);
                    });

}  // namespace
}  // namespace bench
