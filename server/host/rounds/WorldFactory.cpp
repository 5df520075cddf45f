#include "host/rounds/WorldFactory.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "host/rounds/SandboxPolicy.h"
#include "host/settings/GameModule.h"
#include "host/world/Determinism.h"
#include "host/world/WorldProcess.h"
#include "host/world/WorldStart.h"

namespace naiad {

namespace {

static_assert(kMaxServerPlayers <= kMaxViewPlayers);

constexpr const char* kThisProgram = "/proc/self/exe";
constexpr std::chrono::milliseconds kBetweenChecks{10};
constexpr std::size_t kMaxProbeLines = 1000;

std::vector<std::string> ownArguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < all.size(); begin += words.back().size() + 1) {
    words.emplace_back(all.data() + begin);
  }
  return words;
}

/// Returns the options of dfserver that a world needs; the others are for the front process.
std::vector<std::string> moduleArguments(const HostOptions& options, const std::string& module) {
  std::vector<std::string> words{"dfserver", "--game=" + module, "--input-mode=" + options.players,
                                 "--on-game-over=" + options.on_game_over};
  // Worlds of recorded rounds get their seed from WorldStartOptions, so that all runs have equal arguments.
  if (options.seed != 0 && !usesJournal(options)) words.push_back("--seed=" + std::to_string(options.seed));
  return words;
}

std::string gameSettings() {
  const char* p_named = std::getenv("DRAGONFLY_CONFIG");
  return p_named != nullptr ? p_named : "df-config.txt";
}

std::chrono::milliseconds hangTime(const HostOptions& options) {
  return std::chrono::milliseconds(std::llround(options.hang_time * 1000));
}

std::shared_ptr<const WorldLauncher> launch(const HostOptions& options, const GamePaths& place,
                                            std::vector<std::string> arguments, const LogLine& log,
                                            int nice = 0) {
  const SandboxPolicy made = makeSandboxPolicy(options, place);
  auto launcher = std::make_shared<const WorldLauncher>(
      WorldProgram{kThisProgram, std::move(arguments),
                   usesJournal(options) ? makeFixedEnvironment(options) : makeWorldEnvironment(options),
                   firstDirectory(), made.sandbox, determinismPreload(), hangTime(options), nice});
  if (!made.sandbox.on) {
    log("sandbox off: game processes can do everything that this user can");
    return launcher;
  }
  makeUndumpable();
  if (const std::string gaps = missingSandboxFeatures(launcher->support()); !gaps.empty()) log(gaps);
  if (launcher->support().landlock == 0) return launcher;
  for (const std::string& note : made.notes)
    log({note.starts_with("warning: ") ? LogEvent::Level::kWarning : LogEvent::Level::kDebug, note});
  return launcher;
}

RoundJournals::NewWorld replayLater(const std::shared_ptr<const WorldLauncher>& launcher,
                                    WorldStartOptions order, const LogLine& print, asio::io_context& home) {
  order.again = true;  // otherwise a game that sleeps would replay in real time
  return [launcher, order, print, &home] {
    return std::make_unique<WorldProcess>(home, launcher->start(order), print);
  };
}

/// Returns null if there is no round to resume, or it cannot be resumed.
std::unique_ptr<Round> resumeJournaledRound(const std::shared_ptr<const WorldLauncher>& launcher,
                                            const LogLine& print, RoundJournals& journals,
                                            asio::io_context& home) {
  const auto order = journals.resumeOptions();
  if (!order) return nullptr;
  const RoundJournals::NewWorld start = replayLater(launcher, *order, print, home);
  return journals.resumeRound(start(), start);
}

}  // namespace

bool isGameOverPerPlayer(const HostOptions& options) {
  return options.on_game_over != "exit";
}

std::shared_ptr<const WorldLauncher> launchModule(const HostOptions& options, const std::string& module,
                                                  const std::string& config, const LogLine& log, int nice) {
  GamePaths place;
  place.files = {module, gameSettings()};
  place.folders = GameModule::resourceFolders(module);
  place.server_files = {options.log_file,   options.join_file, options.port_file,
                        options.truth_file, options.visitors,  options.control};
  place.secrets = {config, options.state};
  return launch(options, place, moduleArguments(options, module), log, nice);
}

std::shared_ptr<const WorldLauncher> launchProgram(const HostOptions& options, const std::string& log_file,
                                                   const LogLine& log) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::read_symlink(kThisProgram, error).parent_path();
  GamePaths place;
  place.files = {gameSettings()};
  if (!error) place.folders = {folder.string(), folder.parent_path().string()};
  place.logs = {log_file};
  place.server_files = {options.log_file,   options.join_file, options.port_file,
                        options.truth_file, options.visitors,  options.control};
  place.secrets = {options.state};
  place.is_program = true;
  return launch(options, place, ownArguments(), log);
}

std::function<std::unique_ptr<Round>(asio::io_context& home)> startWorlds(
    std::shared_ptr<const WorldLauncher> launcher, LogLine print, std::shared_ptr<RoundJournals> journals) {
  return [launcher = std::move(launcher), print = std::move(print),
          journals = std::move(journals)](asio::io_context& home) -> std::unique_ptr<Round> {
    if (journals == nullptr)
      return std::make_unique<Round>(std::make_unique<WorldProcess>(home, launcher->start(), print));
    if (auto round = resumeJournaledRound(launcher, print, *journals, home)) return round;
    const WorldStartOptions order = journals->makeStartOptions();
    auto world = std::make_unique<WorldProcess>(home, launcher->start(order), print);
    WorldStartOptions again = order;
    again.again = true;
    again.reads_only = true;
    again.copies = false;
    DeterminismCheck::NewWorld start_again;
    if (launcher->support().landlock > 0) {
      start_again = [launcher, again, &home] {
        return std::make_unique<WorldProcess>(home, launcher->start(again), OutputRelay::Line());
      };
    }
    return journals->recordWorld(std::move(world), order, std::move(start_again),
                                 replayLater(launcher, order, print, home));
  };
}

// In the published engine, 33 ms stands for 1/30 s, so it is not a choice of the game.
HostOptions withFrameTime(HostOptions options, const WorldReady& ready) {
  constexpr int kUsualMillis = 33;
  if (options.frame_micros == 0 && ready.frame_millis != kUsualMillis)
    options.frame_micros = ready.frame_millis * 1000;
  return options;
}

std::shared_ptr<const WorldLauncher> launchReplay(const HostOptions& options, const std::string& module,
                                                  const std::string& program, const std::string& folder,
                                                  const std::vector<std::string>& variables) {
  GamePaths place;
  place.files = {program, module};
  place.folders = GameModule::resourceFolders(module);
  SandboxPolicy made = makeSandboxPolicy(options, place);
  made.sandbox.writable = {folder};
  std::vector<std::string> environment = makeFixedEnvironment(options);
  std::erase_if(environment, isGameVariable);
  environment.insert(environment.end(), variables.begin(), variables.end());
  return std::make_shared<const WorldLauncher>(WorldProgram{program, moduleArguments(options, module),
                                                            std::move(environment), folder, made.sandbox,
                                                            determinismPreload(), hangTime(options)});
}

GameProbe probeGame(const WorldLauncher& launcher, const LogLine& print) {
  asio::io_context home;
  std::vector<std::string> lines;
  WorldProcess world(home, launcher.start(), [&lines](const LogEvent& event) {
    if (lines.size() < kMaxProbeLines) lines.push_back(event.text);
  });
  while (!world.ready() && !world.end()) {
    home.restart();
    home.run_one_for(kBetweenChecks);
    world.checkProcess(1);
  }
  if (!world.ready()) std::for_each(lines.begin(), lines.end(), print);
  return {world.ready(), world.end().value_or(WorldEnd())};
}

}  // namespace naiad
