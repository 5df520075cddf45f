// recovery: a server is killed repeatedly while clients play, and the cost of journals is measured.
// docs/bench.md describes it.
#include "ResultLine.h"
#include "Suite.h"

namespace bench {
namespace {

const std::vector<std::string> kGames = {"breakout", "bullethell", "chase",       "hello", "lander",
                                         "maze",     "platformer", "saucershoot", "tron",  "sandbox"};

void run(const char* suite, const std::string& game, const std::vector<std::string>& words) {
  progress(std::string(suite) + ": " + game);
  const Ending ending = printLinesOf("naiad_recovery", words);
  if (ending.code != 0) Line(suite).add("game", game).addZero("failed", 1);
}

const Suite s_suite(
    "recovery", "a server or its world is killed while clients play, who come back; journals are measured",
    [](const Options& options) {
      for (const std::string& game : kGames) {
        run("recovery", game, {"kills", game, options.quick ? "5" : "100"});
        run("long_round", game, {"long", game, options.quick ? "1" : "20"});
        run("take_over", game, {"worlds", game, options.quick ? "3" : "30"});
        run("journal", game, {"journal", game, options.quick ? "900" : "9000"});
      }
      run("hangs", "hanging", {"hangs", options.quick ? "1" : "10"});
      run("scores", "scores", {"scores", options.quick ? "5" : "100"});
    });

}  // namespace
}  // namespace bench
