// dfreplay: plays and checks rounds recorded by dfserver (--journal), by executing them again.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <exception>
#include <iostream>
#include <string>

#include "server/replay/DebugRound.h"
#include "server/replay/RecordedRound.h"
#include "server/replay/RoundPlayer.h"
#include "server/replay/Verify.h"
#include "shared/options/Options.h"
#include "shared/program/ProcessSetup.h"

namespace {

enum ExitCode { kOk = 0, kDiffers = 1, kUsage = 2, kNoRound = 3, kNoTerminal = 4 };

/// Nice value of this process with --for-server.
constexpr int kNice = 10;

constexpr const char* kHelp =
    "In the terminal: space pauses, left and right skip 5 s, . steps one tick, + and - change the speed\n"
    "(1/4 to 64 times), Tab follows the next player, q quits.\n\n"
    "Exit codes: 0 success; 1 --verify, --scores: the replay differs from the recording; 2 wrong usage;\n"
    "3 the file or its game cannot be used; 4 no terminal to play in.\n";

struct ReplayOptions {
  std::string file;
  std::string game;
  bool verify = false;
  bool inputs = false;
  bool scores = false;
  int text = 0;
  int from = 1;
  int until = 0;
  bool debug = false;
  int player = 0;
  bool for_server = false;
};

std::vector<naiad::Option> optionsOf(ReplayOptions& replay) {
  return {
      naiad::typedOption("file", "FILE", &replay.file, "Recording of a round, written by dfserver --journal"),
      {.name = "--verify",
       .target = &replay.verify,
       .help = "Replay and compare with the recording: print ticks and speed, or the first difference"},
      {.name = "--inputs", .target = &replay.inputs, .help = "Print the input of players, tick by tick"},
      {.name = "--scores",
       .target = &replay.scores,
       .help = "Replay and print the scores that the game adds, with the ticks and numbers of dfctl scores"},
      {.name = "--text",
       .target = &replay.text,
       .help = "Print the picture after this tick",
       .range = naiad::OptionRange{1, 2e9},
       .type = "TICK"},
      {.name = "--from",
       .target = &replay.from,
       .help = "In the terminal: start at this tick",
       .range = naiad::OptionRange{1, 2e9},
       .type = "TICK"},
      {.name = "--until",
       .target = &replay.until,
       .help = "With --debug: stop before this tick",
       .range = naiad::OptionRange{1, 2e9},
       .type = "TICK"},
      {.name = "--debug",
       .target = &replay.debug,
       .help = "Attach gdb to the game before the tick of --until, with its recorded clock and addresses"},
      {.name = "--player",
       .target = &replay.player,
       .help = "Player to follow, numbered as in --inputs (default: the first one)",
       .range = naiad::OptionRange{1, 4e9}},
      {.name = "--game",
       .target = &replay.game,
       .help = "Replay this game: a name or the path of a module (default: the installed game that the file "
               "names, if it is unchanged)"},
      {.name = "--for-server",
       .target = &replay.for_server,
       .help = "Run at a lower priority than the server that started this, and end with it",
       .hidden = true}};
}

int fail(ExitCode code, const std::string& sentence) {
  std::cerr << "dfreplay: " << sentence << "\n";
  return code;
}

/// Lowers the priority of this process below the server's, and makes it end with the server. Call before this
/// process starts another one.
void serveParent() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  setpriority(PRIO_PROCESS, 0, kNice);
}

int run(const ReplayOptions& replay) {
  if (replay.for_server) serveParent();
  if (replay.debug != (replay.until > 0))
    return fail(kUsage, "--debug and --until TICK require each other: --until is the tick to stop at.");
  const naiad::RecordedRound round(replay.file);
  if (replay.inputs) {
    naiad::printInputs(round, std::cout);
    return kOk;
  }
  const naiad::ReplayEnvironment environment(round, replay.game);
  const auto player = static_cast<std::uint32_t>(replay.player);
  if (replay.verify) return naiad::verifyRound(round, environment, std::cout) ? kOk : kDiffers;
  if (replay.scores) return naiad::printScores(round, environment, std::cout) ? kOk : kDiffers;
  if (replay.debug) {
    naiad::debugRound(round, environment, static_cast<std::uint32_t>(replay.until), std::cout);
    return kOk;
  }
  if (replay.text > 0) {
    const bool there =
        naiad::printPicture(round, environment, static_cast<std::uint32_t>(replay.text), player, std::cout);
    return there ? kOk : fail(kNoRound, "no picture of this player after this tick.");
  }
  if (!naiad::RoundPlayer::hasTerminal()) return fail(kNoTerminal, "playing a round requires a terminal.");
  naiad::RoundPlayer(round, environment, player, static_cast<std::uint32_t>(replay.from)).run();
  return kOk;
}

}  // namespace

int main(int argc, char** argv) {
  naiad::ignoreBrokenPipes();
  ReplayOptions replay;
  const naiad::Program program{"dfreplay", "Replays rounds that dfserver has recorded.", kHelp, false};
  const auto parsed = naiad::parseOptions(program, optionsOf(replay), argc, argv);
  if (const auto code = naiad::exitCodeOf(parsed)) return *code;
  try {
    return run(replay);
  } catch (const naiad::RoundError& error) {
    return fail(kNoRound, error.what());
  } catch (const std::exception& error) {
    return fail(kNoRound, error.what());
  }
}
