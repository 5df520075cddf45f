// naiad_pty_judge: runs a program that shows the scene in a terminal, types, watches, and prints one line of
// `key=value …` with the results.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "../SharedFile.h"
#include "../link/Link.h"
#include "../scene/Truth.h"
#include "Watch.h"
#include "tests/bench/Guarded.h"
#include "tests/bench/Percentile.h"

namespace {

using namespace bench::path;
using bench::quantile;

constexpr Nanoseconds kStarts{30'000'000'000};  // timeout for the first frame
constexpr Nanoseconds kDrain{3'000'000'000};    // time in which the last keys may still appear

struct Options {
  std::string truth;
  std::string counters;
  std::uint64_t seed = 1;
  double warm_up_s = 5;
  double measure_s = 60;
  bool arrows = false;
  std::string type_ahead;
  std::string first_keys;
  std::vector<std::string> command;
};

Nanoseconds seconds(double value) {
  return Nanoseconds(static_cast<std::int64_t>(value * 1e9));
}

/// Waits until the scene has created the truth file.
SharedFile<Truth> waitForTruth(PtyProgram& program, Terminal& terminal, const std::string& name) {
  const Nanoseconds late = monotonicNow() + kStarts;
  std::string heard;
  while (monotonicNow() < late && !program.hasEnded()) {
    std::string_view bytes = program.read(monotonicNow() + Nanoseconds(20'000'000));
    heard.append(bytes);
    while (!bytes.empty()) bytes = terminal.feed(bytes);
    program.write(terminal.takeAnswers());
    std::error_code none;
    if (std::filesystem::file_size(name, none) == sizeof(Truth) && !none)
      return SharedFile<Truth>::open(name);
  }
  throw std::runtime_error("the scene did not begin; on the screen: " + heard);
}

double lateP99Ms(const LinkCounters& counters) {
  std::uint64_t all = 0;
  for (const auto& step : counters.late) all += step;
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < counters.late.size(); ++i) {
    seen += counters.late[i];
    if (seen * 100 >= all * 99) return static_cast<double>(i + 1) * LinkCounters::kLateStepNanos / 1e6;
  }
  return 0;
}

std::string textOf(const Picture& screen) {
  std::string text;
  for (int y = 0; y < kHeight; ++y) {
    text += '\n';
    for (int x = 0; x < kWidth; ++x) text += screen.at(x, y).ch;
  }
  return text;
}

void print(const char* key, double value) {
  if (!std::isnan(value)) std::printf("%s=%.4f ", key, value);
}

/// Prints the figures measured in [from, to).
void report(const Watch& watch, Nanoseconds from, Nanoseconds to) {
  const Fluency fluency = fluencyOf(watch.frames().shown(), from, to);
  print("fps", fluency.frames_per_second);
  print("staleness_p50_ms", fluency.staleness_p50_ms);
  print("staleness_p99_ms", fluency.staleness_p99_ms);
  print("freeze_ms", fluency.freeze_ms);
  const std::vector<double> keys = watch.letters().latencies(from, to);
  print("key_p50_ms", quantile(keys, 0.5));
  print("key_p99_ms", quantile(keys, 0.99));
  print("predicted_key_p99_ms", quantile(watch.arrows().latencies(from, to), 0.99));
  print("keys_lost",
        static_cast<double>(watch.letters().unanswered(from, to) + watch.arrows().unanswered(from, to)));
  const auto in_window = [&](Nanoseconds at) { return at >= from && at < to; };
  const auto& refused = watch.frames().refused();
  print("refused_frames", static_cast<double>(std::count_if(refused.begin(), refused.end(), in_window)));
}

int judge(const Options& options) {
  Terminal terminal;
  PtyProgram program(options.command);
  program.write(options.type_ahead);
  becomePunctual();
  const auto truth = waitForTruth(program, terminal, options.truth);
  const auto link = SharedFile<LinkCounters>::open(options.counters);
  Watch watch(program, terminal, *truth, Typist(options.seed, options.arrows, monotonicNow()),
              options.first_keys);
  watch.untilShown(monotonicNow() + kStarts);
  if (watch.frames().shown().empty()) {
    throw std::runtime_error("no frame was right; the last one to " +
                             std::to_string(watch.frames().lastLikeness()) +
                             " %:" + textOf(terminal.picture()));
  }
  watch.until(monotonicNow() + seconds(options.warm_up_s));
  const std::uint64_t down = link->down;
  const std::uint64_t up = link->up;
  const Nanoseconds from = monotonicNow();
  const Nanoseconds to = from + seconds(options.measure_s);
  watch.until(to);
  print("kbit_s_down", static_cast<double>(link->down - down) * 8 / 1000 / options.measure_s);
  print("kbit_s_up", static_cast<double>(link->up - up) * 8 / 1000 / options.measure_s);
  watch.until(to + kDrain);

  report(watch, from, to);
  print("link_late_p99_ms", lateP99Ms(*link));
  std::printf("\n");
  return 0;
}

int start(int argc, char** argv) {
  Options options;
  CLI::App app("Judges a program that shows the scene in a terminal.", "naiad_pty_judge");
  app.add_option("--truth", options.truth, "File of the scene's Truth")->required();
  app.add_option("--counters", options.counters, "File of the link's LinkCounters")->required();
  app.add_option("--seed", options.seed, "Of the moments at which keys are pressed");
  app.add_option("--warm-up", options.warm_up_s, "Seconds before measuring")->check(CLI::Range(0.0, 3600.0));
  app.add_option("--measure", options.measure_s, "Seconds")->check(CLI::Range(1.0, 3600.0));
  app.add_flag("--arrows", options.arrows, "Also press arrow keys, for predicted_key_p99_ms");
  app.add_option("--type-ahead", options.type_ahead, "Typed at once");
  app.add_option("--first-keys", options.first_keys, "Typed as soon as the scene is on the screen");
  app.add_option("command", options.command, "What to run")->required();
  app.positionals_at_end();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return judge(options);
}

}  // namespace

int main(int argc, char** argv) {
  return bench::guarded("naiad_pty_judge", [&] { return start(argc, argv); });
}
