// attack: attacks the real programs while honest players play. docs/bench.md describes it.
#include "ResultLine.h"
#include "Suite.h"

namespace bench {
namespace {

const std::vector<std::string> kNames = {"silent4",    "silent6",     "chat_resume",  "chat_detached",
                                         "hard_pile",  "held_places", "log_stall",    "log_gone",
                                         "password80", "fork300",     "restart8",     "rounds5",
                                         "door3000",   "idle64",      "password2000", "bus20k"};

void attack(const std::string& name, bool quick) {
  progress("attack: " + name);
  std::vector<std::string> words{name};
  if (quick) words.emplace_back("--quick");
  if (printLinesOf("naiad_attack", words) != 0)
    Line("attack").add("name", name).addZero("failed", 1).add("because", "not_measured");
}

const Suite s_suite("attack", "strangers attack the real programs while honest players play",
                    [](const Options& options) {
                      for (const std::string& name : namesFrom("NAIAD_ATTACK_NAMES", kNames))
                        attack(name, options.quick);
                    });

}  // namespace
}  // namespace bench
