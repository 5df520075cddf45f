// naiad_hunt: draws random scenes of bodies, runs them and asks judges what must hold in all of them. Every
// scene is drawn from a seed of its own, so each can be repeated alone.
#include <signal.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "Judges.h"
#include "Shrink.h"
#include "shared/options/Options.h"

namespace {

using hunt::Judge;
using hunt::SceneData;
using hunt::Verdict;

constexpr double kDefaultSeconds = 10;
constexpr unsigned kMaxSceneSeconds = 120;
constexpr int kShrinkTries = 400, kShrinkTriesOfLongScenes = 12;

struct Settings {
  std::uint64_t seed = 1;
  std::int64_t scenes = 0;
  double seconds = 0;
  int shrink = 3;
  std::string only, limits;
  std::optional<std::uint64_t> scene;
  const Judge* p_only = nullptr;
  std::map<std::string, long> ceilings;
};

struct Tally {
  long applied = 0;
  long violations = 0;
  std::uint64_t first_seed = 0;
};

double secondsSinceStart() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Message that names the scene in which the program crashes or hangs.
std::array<char, 80> s_last_words;
volatile sig_atomic_t s_last_size = 0;

void prepareLastWords(std::uint64_t seed) {
  s_last_size =
      std::snprintf(s_last_words.data(), s_last_words.size(), "\nnaiad_hunt: crash or hang in scene %llu\n",
                    static_cast<unsigned long long>(seed));
}

extern "C" void onCrash(int /*signal*/) {
  [[maybe_unused]] const auto written =
      write(STDERR_FILENO, s_last_words.data(), static_cast<std::size_t>(s_last_size));
  _exit(1);
}

// Returns the region that a scene belongs to if docs/physics/ excludes it, else null.
const char* excludedRegionOf(const SceneData& scene) {
  constexpr double kMaxMassRatio = 1e6;
  double least = 1e300, most = 0;
  for (const hunt::BodyData& body : scene.bodies) {
    if (!body.isDynamic()) continue;
    least = std::min(least, body.mass);
    most = std::max(most, body.mass);
  }
  return most > kMaxMassRatio * least ? "mass_ratio" : nullptr;
}

class Hunt {
 public:
  explicit Hunt(const Settings& settings) : m_settings(settings) {}

  int run() {
    while (!isOver()) {
      examine(m_settings.seed + static_cast<std::uint64_t>(m_scenes + m_excluded));
      showProgress();
    }
    if (m_shows_progress) std::fputs("\r\033[K", stderr);
    return report();
  }

 private:
  bool isOver() const {
    if (m_settings.scenes > 0) return m_scenes >= m_settings.scenes;
    return secondsSinceStart() >= m_settings.seconds;
  }

  void examine(std::uint64_t seed) {
    prepareLastWords(seed);
    alarm(kMaxSceneSeconds);
    const SceneData scene = hunt::drawScene(seed);
    if (const char* p_region = excludedRegionOf(scene); p_region != nullptr) {
      ++m_regions[p_region];
      ++m_excluded;
      return;
    }
    ++m_scenes;
    for (const Verdict& verdict : hunt::judgeScene(scene, m_settings.p_only)) {
      Tally& tally = m_tallies[verdict.p_judge->name];
      tally.applied += verdict.applied;
      if (!verdict.finding) continue;
      if (tally.violations++ == 0) tally.first_seed = seed;
      ++m_violations;
      show(scene, verdict, tally.violations > ceilingOf(*verdict.p_judge));
    }
    alarm(0);
  }

  long ceilingOf(const Judge& judge) const {
    const auto found = m_settings.ceilings.find(judge.name);
    return found == m_settings.ceilings.end() ? 0 : found->second;
  }

  void show(const SceneData& scene, const Verdict& verdict, bool is_unknown) {
    if (m_shows_progress) std::fputs("\r\033[K", stderr);
    std::printf("hunt judge=%s seed=%llu family=%s level=%s tick=%d value=%.4g limit=%.4g\n",
                verdict.p_judge->name, static_cast<unsigned long long>(scene.seed), scene.family.c_str(),
                scene.level == df::ACCURACY_FAST ? "fast" : "default", verdict.finding->tick,
                verdict.finding->value, verdict.finding->limit);
    std::fflush(stdout);
    if (!is_unknown || m_shrunk >= m_settings.shrink) return;
    ++m_shrunk;
    alarm(0);
    const int tries = scene.ticks >= 1000 ? kShrinkTriesOfLongScenes : kShrinkTries;
    const SceneData small = hunt::shrink(scene, *verdict.p_judge, tries);
    std::fprintf(stderr, "%s\n",
                 hunt::programOf(small, verdict.p_judge->name + (": " + verdict.finding->text) + ". Scene " +
                                            std::to_string(scene.seed))
                     .c_str());
  }

  void showProgress() {
    if (!m_shows_progress || secondsSinceStart() < m_next_progress) return;
    m_next_progress = secondsSinceStart() + .2;
    constexpr int kWidth = 30;
    const double part = m_settings.scenes > 0
                            ? static_cast<double>(m_scenes) / static_cast<double>(m_settings.scenes)
                            : secondsSinceStart() / m_settings.seconds;
    const int done = std::min(kWidth, static_cast<int>(kWidth * part));
    std::fprintf(stderr, "\r[%.*s%*s] %ld scenes, %ld violations", done, "##############################",
                 kWidth - done, "", static_cast<long>(m_scenes), m_violations);
  }

  int report() const {
    bool is_good = true;
    for (const Judge& judge : hunt::judges()) {
      if (m_settings.p_only != nullptr && m_settings.p_only != &judge) continue;
      const auto found = m_tallies.find(judge.name);
      const Tally tally = found == m_tallies.end() ? Tally{} : found->second;
      const long allowed = ceilingOf(judge);
      std::printf("hunt judge=%s applied=%ld violations=%ld allowed=%ld", judge.name, tally.applied,
                  tally.violations, allowed);
      if (tally.violations > 0)
        std::printf(" first_seed=%llu", static_cast<unsigned long long>(tally.first_seed));
      std::printf("\n");
      is_good = is_good && tally.violations <= allowed;
    }
    const double drawn = static_cast<double>(std::max<std::int64_t>(m_scenes + m_excluded, 1));
    for (const auto& [region, count] : m_regions)
      std::printf("hunt left_out=%s share_percent=%.2f\n", region.c_str(),
                  100 * static_cast<double>(count) / drawn);
    std::printf("hunt scenes=%lld seconds=%.1f violations=%ld seed=%llu\n", static_cast<long long>(m_scenes),
                secondsSinceStart(), m_violations, static_cast<unsigned long long>(m_settings.seed));
    return is_good ? 0 : 1;
  }

  const Settings& m_settings;
  std::int64_t m_scenes = 0;  ///< examined
  std::int64_t m_excluded = 0;
  long m_violations = 0;
  int m_shrunk = 0;
  std::map<std::string, Tally> m_tallies;
  std::map<std::string, long> m_regions;
  const bool m_shows_progress = isatty(STDERR_FILENO) != 0;
  double m_next_progress = 0;
};

// Prints one scene as a program, with --only JUDGE shrunk, and what the judges find in it.
int showScene(const Settings& settings) {
  SceneData scene = hunt::drawScene(*settings.scene);
  bool is_good = true;
  for (const Verdict& verdict : hunt::judgeScene(scene, settings.p_only)) {
    std::string text = verdict.applied ? "holds" : "does not apply";
    if (verdict.finding)
      text = "tick " + std::to_string(verdict.finding->tick) + ": " + verdict.finding->text + ": " +
             std::to_string(verdict.finding->value) + ", limit " + std::to_string(verdict.finding->limit);
    std::fprintf(stderr, "%s: %s\n", verdict.p_judge->name, text.c_str());
    is_good = is_good && !verdict.finding;
  }
  if (settings.p_only != nullptr && !is_good) scene = hunt::shrink(scene, *settings.p_only, kShrinkTries);
  std::fputs(hunt::programOf(scene, scene.family + ", scene " + std::to_string(scene.seed)).c_str(), stdout);
  return is_good ? 0 : 1;
}

std::string storeJudge(const std::string& name, Settings& settings) {
  settings.p_only = hunt::judgeNamed(name);
  if (settings.p_only != nullptr) return "";
  std::vector<std::string> names;
  for (const Judge& judge : hunt::judges()) names.push_back(judge.name);
  return "unknown judge" + naiad::suggestion(name, names);
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

std::string judgesHelp() {
  std::string text = "Judges:\n";
  for (const Judge& judge : hunt::judges())
    text += std::string("  ") + judge.name + std::string(12 - std::string(judge.name).size(), ' ') +
            judge.rule + "\n";
  return text +
         "\nStdout has only key=value lines: one per violation, one per judge, then the totals. Failing "
         "scenes\n"
         "go to stderr as programs.\n"
         "Exit codes: 0 no violation, or none above --limits, 1 violations, 2 wrong usage.";
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  const std::vector<naiad::Option> options = {
      naiad::typedOption("--seed", "N", naiad::StoreText([&](const std::string& text) {
                           settings.seed = std::strtoull(text.c_str(), nullptr, 10);
                           return std::string();
                         }),
                         "Seed of the first scene; the next scenes have the next seeds (default: 1)"),
      {"--scenes", &settings.scenes, "Number of scenes"},
      {"--seconds", &settings.seconds, "Time limit, if --scenes is not given (default: 10)"},
      {"--shrink", &settings.shrink,
       "Number of failing scenes, above --limits, to shrink and print (default: 3)"},
      naiad::typedOption("--only", "JUDGE", naiad::StoreText([&](const std::string& text) {
                           return storeJudge(text, settings);
                         }),
                         "Ask only this judge"),
      {"--scene", &settings.scene, "Print this scene as a program, with --only shrunk, and its judgements"},
      naiad::typedOption("--limits", "LIMITS", naiad::StoreText([&](const std::string& text) {
                           return storeLimits(text, settings);
                         }),
                         "Allowed violations per judge, such as \"gain=2 overlap=1\" (default: none)")};
  const naiad::Program program{"naiad_hunt", "Hunts for scenes of bodies in which an invariant fails",
                               judgesHelp()};
  if (const auto code = naiad::exitCodeOf(naiad::parseOptions(program, options, argc, argv))) return *code;
  if (settings.seconds <= 0) settings.seconds = kDefaultSeconds;
  secondsSinceStart();
  for (const int signal : {SIGABRT, SIGSEGV, SIGFPE, SIGALRM}) ::signal(signal, onCrash);
  return settings.scene ? showScene(settings) : Hunt(settings).run();
}
