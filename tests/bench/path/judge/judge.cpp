// naiad_pty_judge: sits at a terminal, runs a program that shows the scene, types, watches, and prints one line
// of `key=value …` about what it saw.
#include <sched.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "../SharedFile.h"
#include "../link/LinkCounters.h"
#include "../scene/Status.h"
#include "../scene/Truth.h"
#include "EchoJudge.h"
#include "FrameJudge.h"
#include "PtyProgram.h"
#include "Quantile.h"
#include "Terminal.h"
#include "Typist.h"

namespace {

using namespace bench::path;

constexpr Nanoseconds kStarts{30'000'000'000};  // until the first frame
constexpr Nanoseconds kDrain{3'000'000'000};    // for keys that are still on their way

struct Options {
  std::string truth;
  std::string counters;
  std::uint64_t seed = 1;
  double warm_up_s = 5;
  double measure_s = 60;
  bool arrows = false;
  std::string first_keys;
  std::vector<std::string> command;
};

Nanoseconds seconds(double value) {
  return Nanoseconds(static_cast<std::int64_t>(value * 1e9));
}

void hurry() {
  prctl(PR_SET_TIMERSLACK, 1UL);
  sched_param priority{};
  priority.sched_priority = 1;
  sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &priority);  // a wish: not everybody may
}

/// The scene makes the file of the truth when it starts, in its own time.
SharedFile<Truth> waitForTruth(PtyProgram& program, Terminal& terminal, const std::string& name) {
  const Nanoseconds late = monotonicNow() + kStarts;
  std::string heard;
  while (monotonicNow() < late && !program.hasEnded()) {
    std::string_view bytes = program.read(monotonicNow() + Nanoseconds(20'000'000));
    heard.append(bytes);
    while (!bytes.empty()) bytes = terminal.feed(bytes);
    program.write(terminal.takeAnswers());
    std::error_code none;
    if (std::filesystem::file_size(name, none) == sizeof(Truth) && !none) return SharedFile<Truth>::open(name);
  }
  throw std::runtime_error("the scene did not begin; on the screen: " + heard);
}

class Watch {
 public:
  Watch(const Options& options, PtyProgram& program, Terminal& terminal, const Truth& truth)
      : m_program(program),
        m_terminal(terminal),
        m_frames(truth),
        m_first_keys(options.first_keys),
        m_typist(options.seed, options.arrows, monotonicNow()) {}

  /// Type and look until `end`, or until something is on the screen.
  void until(Nanoseconds end, bool until_shown = false) {
    while (monotonicNow() < end && !(until_shown && !m_frames.shown().empty())) {
      if (!until_shown) type();
      const std::string_view bytes = m_program.read(std::min(end, until_shown ? end : m_typist.next()));
      if (m_program.hasEnded()) throw std::runtime_error("the program has ended");
      if (!bytes.empty()) look(bytes);
    }
  }
  const FrameJudge& frames() const { return m_frames; }
  const EchoJudge& letters() const { return m_letters; }
  const EchoJudge& arrows() const { return m_arrows; }

 private:
  /// Several frames may come at once: look at each.
  void look(std::string_view bytes) {
    const Nanoseconds now = monotonicNow();
    Picture screen;
    while (!bytes.empty()) {
      bytes = m_terminal.feed(bytes);
      screen = m_terminal.picture();
      m_frames.look(screen, now);
    }
    m_program.write(m_terminal.takeAnswers());
    if (counterIn(screen)) m_program.write(std::exchange(m_first_keys, {}));
    const char echo = screen.at(kEchoColumn, kStatusRow).ch;
    if (echo >= 'a' && echo <= 'z') m_letters.look(static_cast<std::uint32_t>(echo - 'a'), now);
    if (const auto marker = markerIn(screen)) m_arrows.look((*marker + 3) % 4, now);
  }

  void type() {
    const Nanoseconds now = monotonicNow();
    const auto key = m_typist.due(now);
    if (!key) return;
    if (*key == Typist::Key::kLetter) {
      const char letter = static_cast<char>('a' + m_letters.press(now) % 26);
      m_program.write({&letter, 1});
    } else {
      m_terminal.pressArrow(m_arrows.press(now));
      m_program.write(m_terminal.takeAnswers());
    }
  }

  PtyProgram& m_program;
  Terminal& m_terminal;
  FrameJudge m_frames;
  std::string m_first_keys;
  Typist m_typist;
  EchoJudge m_letters{26};
  EchoJudge m_arrows{4};
};

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

int judge(const Options& options) {
  Terminal terminal;
  PtyProgram program(options.command);
  hurry();
  const auto truth = waitForTruth(program, terminal, options.truth);
  const auto link = SharedFile<LinkCounters>::open(options.counters);
  Watch watch(options, program, terminal, *truth);
  watch.until(monotonicNow() + kStarts, true);
  if (watch.frames().shown().empty()) {
    throw std::runtime_error("no frame was right; the last one to " +
                             std::to_string(watch.frames().lastLikeness()) + " %:" +
                             textOf(terminal.picture()));
  }
  watch.until(monotonicNow() + seconds(options.warm_up_s));
  const std::uint64_t down = link->down.bytes;
  const std::uint64_t up = link->up.bytes;
  const Nanoseconds from = monotonicNow();
  const Nanoseconds to = from + seconds(options.measure_s);
  watch.until(to);
  print("kbit_s_down", static_cast<double>(link->down.bytes - down) * 8 / 1000 / options.measure_s);
  print("kbit_s_up", static_cast<double>(link->up.bytes - up) * 8 / 1000 / options.measure_s);
  watch.until(to + kDrain);

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
  try {
    return start(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "naiad_pty_judge: %s\n", error.what());
    return 1;
  }
}
