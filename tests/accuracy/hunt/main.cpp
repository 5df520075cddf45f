// naiad_hunt: draws random scenes of bodies, runs them and asks judges what must hold in all of them. Every
// scene is drawn from a seed of its own, so each can be repeated alone.
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>

#include "Judges.h"
#include "Shrink.h"
#include "shared/options/Options.h"

namespace {

using hunt::Judge;
using hunt::SceneData;

constexpr unsigned kMaxSceneSeconds = 120;
constexpr double kMaxMassRatio = 1e6;  // docs/physics/rigid.md excludes greater ones
constexpr int kShrinkTries = 400, kShrinkTriesOfLongScenes = 12;

struct Settings {
  std::uint64_t seed = 1;
  std::int64_t scenes = 0;
  double seconds = 10;
  int shrink = 3;
  std::optional<std::uint64_t> scene;
  const Judge* p_only = nullptr;
  std::map<std::string, long> ceilings;
};

// Message that names the scene in which the program crashes or hangs.
std::array<char, 80> s_last_words;
volatile sig_atomic_t s_last_size = 0;

extern "C" void onCrash(int /*signal*/) {
  [[maybe_unused]] const auto written =
      write(STDERR_FILENO, s_last_words.data(), static_cast<std::size_t>(s_last_size));
  _exit(1);
}

class Hunt {
 public:
  explicit Hunt(const Settings& settings) : m_settings(settings) {}

  int run() {
    const auto seconds = [start = std::chrono::steady_clock::now()] {
      return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    while (m_settings.scenes > 0 ? m_scenes < m_settings.scenes : seconds() < m_settings.seconds)
      examine(m_settings.seed + static_cast<std::uint64_t>(m_scenes + m_excluded));
    long all = 0;
    bool is_good = true;
    for (const Judge& judge : hunt::judges()) {
      if (m_settings.p_only != nullptr && m_settings.p_only != &judge) continue;
      const Tally& tally = m_tallies[&judge];
      std::printf("hunt judge=%s applied=%ld violations=%ld allowed=%ld", judge.name.c_str(), tally.applied,
                  tally.violations, ceilingOf(judge));
      if (tally.violations > 0) std::printf(" first_seed=%llu", tally.first_seed);
      std::printf("\n");
      all += tally.violations;
      is_good = is_good && tally.violations <= ceilingOf(judge);
    }
    if (m_excluded > 0)
      std::printf("hunt left_out=mass_ratio share_percent=%.2f\n",
                  100 * static_cast<double>(m_excluded) / static_cast<double>(m_scenes + m_excluded));
    std::printf("hunt scenes=%ld seconds=%.1f violations=%ld seed=%llu\n", m_scenes, seconds(), all,
                static_cast<unsigned long long>(m_settings.seed));
    return is_good ? 0 : 1;
  }

 private:
  struct Tally {
    long applied = 0;
    long violations = 0;
    unsigned long long first_seed = 0;
  };

  void examine(std::uint64_t seed) {
    s_last_size =
        std::snprintf(s_last_words.data(), s_last_words.size(), "\nnaiad_hunt: crash or hang in scene %llu\n",
                      static_cast<unsigned long long>(seed));
    const SceneData scene = hunt::drawScene(seed);
    if (hunt::massRatio(scene) > kMaxMassRatio) {
      ++m_excluded;
      return;
    }
    ++m_scenes;
    alarm(kMaxSceneSeconds);
    const auto answers = hunt::judgeScene(scene, m_settings.p_only);
    alarm(0);
    for (const auto& [p_judge, answer] : answers) {
      Tally& tally = m_tallies[p_judge];
      tally.applied += answer.applies;
      if (!answer.finding) continue;
      if (tally.violations++ == 0) tally.first_seed = seed;
      show(scene, *p_judge, *answer.finding, tally.violations > ceilingOf(*p_judge));
    }
  }

  long ceilingOf(const Judge& judge) const {
    const auto found = m_settings.ceilings.find(judge.name);
    return found == m_settings.ceilings.end() ? 0 : found->second;
  }

  void show(const SceneData& scene, const Judge& judge, const hunt::Finding& finding, bool is_unknown) {
    std::printf("hunt judge=%s seed=%llu family=%s level=%s tick=%d value=%.4g limit=%.4g\n",
                judge.name.c_str(), static_cast<unsigned long long>(scene.seed), scene.family.c_str(),
                scene.isFast() ? "fast" : "default", finding.tick, finding.value, finding.limit);
    std::fflush(stdout);
    if (!is_unknown || m_shrunk >= m_settings.shrink) return;
    ++m_shrunk;
    const SceneData small =
        hunt::shrink(scene, judge, scene.ticks >= 1000 ? kShrinkTriesOfLongScenes : kShrinkTries);
    const std::string comment = judge.name + ": " + finding.text + ". Scene " + std::to_string(scene.seed);
    std::fprintf(stderr, "%s\n", hunt::programOf(small, comment).c_str());
  }

  const Settings& m_settings;
  long m_scenes = 0;  // examined
  long m_excluded = 0;
  int m_shrunk = 0;
  std::map<const Judge*, Tally> m_tallies;
};

// Prints one scene as a program, with --only JUDGE shrunk, and what the judges find in it.
int showScene(const Settings& settings) {
  SceneData scene = hunt::drawScene(*settings.scene);
  bool is_good = true;
  for (const auto& [p_judge, answer] : hunt::judgeScene(scene, settings.p_only)) {
    std::string text = answer.applies ? "holds" : "does not apply";
    if (const auto& found = answer.finding)
      text = "tick " + std::to_string(found->tick) + ": " + found->text + ": " +
             std::to_string(found->value) + ", limit " + std::to_string(found->limit);
    std::fprintf(stderr, "%s: %s\n", p_judge->name.c_str(), text.c_str());
    is_good = is_good && !answer.finding;
  }
  if (settings.p_only != nullptr && !is_good) scene = hunt::shrink(scene, *settings.p_only, kShrinkTries);
  std::fputs(hunt::programOf(scene, scene.family + ", scene " + std::to_string(scene.seed)).c_str(), stdout);
  return is_good ? 0 : 1;
}

std::string storeJudge(const std::string& name, Settings& settings) {
  settings.p_only = hunt::judgeNamed(name);
  return settings.p_only != nullptr ? "" : "there is no judge " + name;
}

std::string storeLimits(const std::string& text, Settings& settings) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || hunt::judgeNamed(word.substr(0, equals)) == nullptr)
      return "expected JUDGE=COUNT, not " + word;
    settings.ceilings[word.substr(0, equals)] = std::atol(word.c_str() + equals + 1);
  }
  return "";
}

}  // namespace

int main(int argc, char** argv) {
  using naiad::StoreText, naiad::typedOption;
  Settings settings;
  std::optional<std::uint64_t> seed;
  const std::vector<naiad::Option> options = {
      {"--seed", &seed, "Seed of the first scene; the next scenes have the next seeds (default: 1)"},
      {"--scenes", &settings.scenes, "Number of scenes"},
      {"--seconds", &settings.seconds, "Time limit, if --scenes is not given (default: 10)"},
      {"--shrink", &settings.shrink,
       "Number of failing scenes, above --limits, to shrink and print (default: 3)"},
      typedOption("--only", "JUDGE", StoreText([&](auto& text) { return storeJudge(text, settings); }),
                  "Ask only this judge"),
      {"--scene", &settings.scene, "Print this scene as a program, with --only shrunk, and its judgements"},
      typedOption("--limits", "LIMITS", StoreText([&](auto& text) { return storeLimits(text, settings); }),
                  "Allowed violations per judge, such as \"gain=2 overlap=1\" (default: none)")};
  std::string footer = "Judges (docs/physics/lab.md):";
  for (const Judge& judge : hunt::judges()) footer += " " + judge.name;
  footer +=
      "\n\nStdout has only key=value lines: one per violation, one per judge, then the totals. Failing "
      "scenes\n"
      "go to stderr as programs.\n"
      "Exit codes: 0 no violation, or none above --limits, 1 violations, 2 wrong usage.";
  const naiad::Program program{"naiad_hunt", "Hunts for scenes of bodies in which an invariant fails",
                               footer};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, options, argc, argv))) return *code;
  settings.seed = seed.value_or(settings.seed);
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGALRM}) ::signal(signal, onCrash);
  return settings.scene ? showScene(settings) : Hunt(settings).run();
}
