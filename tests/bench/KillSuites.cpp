// Suites that each run one program while servers are attacked or killed, or rooms fail. docs/bench.md
// describes them.
#include "ResultLine.h"
#include "Suite.h"

namespace bench {
namespace {

const std::vector<std::string> kGames = {"breakout", "bullethell", "chase",       "hello", "lander",
                                         "maze",     "platformer", "saucershoot", "tron",  "sandbox"};

void run(const char* suite, const std::string& game, const std::vector<std::string>& words) {
  progress(std::string(suite) + ": " + game);
  if (printLinesOf("naiad_recovery", words) != 0) Line(suite).add("game", game).addZero("failed", 1);
}

const std::vector<std::string> kAttacks = {"silent4",    "silent6",     "chat_resume",  "chat_detached",
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

const Suite s_attack("attack", "strangers attack the real programs while honest players play",
                     [](const Options& options) {
                       for (const std::string& name : namesFrom("NAIAD_ATTACK_NAMES", kAttacks))
                         attack(name, options.quick);
                     });

const Suite s_fleet("fleet",
                    "ten servers are killed at random while players of a directory play, and their bus",
                    [](const Options& options) {
                      progress("fleet");
                      const std::vector<std::string> quick = {"40", "3", "5", "30", "4"};
                      const std::vector<std::string> whole = {"1000", "20", "60", "10"};
                      if (printLinesOf("naiad_fleet", options.quick ? quick : whole) != 0)
                        Line("fleet").addZero("failed", 1);
                    });

const Suite s_rooms("rooms", "players of rooms notice nothing of others that burn a core, crash and hang",
                    [](const Options& options) {
                      progress("rooms");
                      if (printLinesOf("naiad_rooms", {options.quick ? "10" : "120"}) != 0)
                        Line("rooms").addZero("failed", 1);
                    });

const Suite s_recovery(
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
