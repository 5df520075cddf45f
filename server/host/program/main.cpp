// dfserver: starts the game's worlds in their own processes and serves players for them. Each world process,
// or with --in-process this process, loads the game, installs a runner, and calls the game's main().
#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/managers/GameManager.h"
#include "engine/managers/LogManager.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "host/auth/Seed.h"
#include "host/loop/Host.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/loop/OperatorLibrary.h"
#include "host/net/InheritedSockets.h"
#include "host/process/CrashReport.h"
#include "host/process/ReexecCommand.h"
#include "host/program/Announcement.h"
#include "host/rounds/RoomLauncher.h"
#include "host/rounds/RoundHandover.h"
#include "host/rounds/SandboxPolicy.h"
#include "host/rounds/WorldFactory.h"
#include "host/settings/DefaultFolders.h"
#include "host/settings/GameModule.h"
#include "host/settings/HostOptions.h"
#include "host/settings/HostOptionsCheck.h"
#include "host/world/WorldServer.h"
#include "host/world/WorldStart.h"
#include "proto/ParseErrors.h"
#include "shared/program/LineLog.h"
#include "shared/program/LogText.h"
#include "shared/program/ProcessSetup.h"
#include "shared/values/Version.h"

namespace {

enum ExitCode { kOk = 0, kGameFailed = 1, kUsage = 2, kNoGame = 3, kCannotListen = 4, kFile = 5 };

const naiad::AccessHints kOpenness{"--address :: allows other machines.",
                                   "--address 127.0.0.1 restricts it to this machine."};

/// Connects games to the host while it exists, however the game ends: the game's statics outlive the host.
struct Installed {
  Installed(df::Runner& runner, const naiad::Host::Log& log) {
    LM.setSink(log);
    GM.setRunner(&runner);
  }
  ~Installed() {
    GM.setRunner(nullptr);
    LM.setSink({});
  }
  Installed(const Installed&) = delete;
  Installed& operator=(const Installed&) = delete;
};

/// Runs the game's main(). The game failed if it throws, returns an error, or returns without GM.run().
ExitCode play(const naiad::GameModule& game) {
  try {
    const int result = game.main();
    if (!df::World::current().hasBegun() && result == 0) {
      std::cerr << "dfserver: the game's main() returned without GM.run(), so nothing was played\n";
      return kGameFailed;
    }
    if (result == 0) return kOk;
    std::cerr << "dfserver: the game ended with code " << result << "\n";
  } catch (const std::exception& error) {
    std::cerr << "dfserver: the game failed: " << error.what() << "\n";
  } catch (...) {
    std::cerr << "dfserver: the game failed\n";
  }
  return kGameFailed;
}

/// Returns a log for lines of a game. It marks the lines, because they may contain player names and could
/// look like lines of the server.
naiad::LogLine markedLog(naiad::LineLog& log) {
  return [&log](const std::string& line) { log({"game", "game: " + line, {}}); };
}

/// Runs the game in a host, which listens `where`, or if that is empty in a world process that a host has
/// started. `game_log` receives the game's own lines.
ExitCode play(const naiad::GameModule& game, const std::string& where, df::Runner& runner,
              naiad::HostOptions& options, naiad::LineLog& log, const naiad::LogLine& game_log) {
  const auto given = naiad::takeWorldSeed();
  if (given) options.seed = static_cast<std::int64_t>(*given);
  if (options.seed == 0) options.seed = static_cast<std::int64_t>(naiad::newSeed());
  for (const std::string& folder : game.resourceFolders())
    df::World::current().extras().resources.addFolder(folder);
  const Installed installed(runner, game_log);
  GM.setSeed(static_cast<std::uint64_t>(options.seed));
  if (!where.empty())
    log("dfserver " + std::string(naiad::kVersion) + " hosts " + game.name() + " on " + where);
  log("seed " + std::to_string(options.seed));
  return play(game);
}

void announce(const naiad::HostOptions& options, const naiad::Host& host) {
  naiad::writeEndpointFiles(options, host.endpoint());
  for (const std::string& line : naiad::joinInstructions(host.endpoint(), options, kOpenness))
    std::cout << line << std::endl;
  for (const std::string& line : naiad::qrLines(options)) std::cout << line << std::endl;
}

/// Sets the window size, help and tick settings of the game for this server. No game ticks in this world.
void setUp(df::World& world, const naiad::WorldReady& ready) {
  world.views().setWindow(ready.window_width, ready.window_height);
  world.setCompat(ready.compat);
  world.setHelp(ready.help);
  world.extras().settings.frame_time = ready.frame_millis;
  world.extras().settings.runs_empty = ready.runs_empty;
}

ExitCode failGame(const std::string& how) {
  std::cerr << "dfserver: the game " << how << "\n";
  return kGameFailed;
}

/// Reports that the game ended before players could join. Returns the exit code.
ExitCode failPreview(const naiad::WorldEnd& end) {
  if (end.why == naiad::WorldEnd::kGameOver) return kOk;
  if (end.exit_code == kNoGame) return kNoGame;  // the world's process has printed the reason
  for (const std::string& line : end.last_lines) std::cerr << "dfserver: the game's log: " << line << "\n";
  return failGame(end.text + (end.when.empty() ? " before GM.run()" : " " + end.when));
}

void useLogOptions(const naiad::HostOptions& options, naiad::LineLog& lines) {
  constexpr std::string_view kLevels[] = {"error", "warning", "info", "debug"};  // as LogEvent::Level
  lines.setFormat(options.log_format == "json" ? naiad::LogFormat::kJson : naiad::LogFormat::kText);
  const auto* const p_level = std::find(std::begin(kLevels), std::end(kLevels), options.log_level);
  lines.setLevel(static_cast<naiad::LogEvent::Level>(p_level - std::begin(kLevels)));
}

/// How this process was started, and how to restart it.
struct Start {
  naiad::ReexecCommand command;
  naiad::HostOptions options;
  std::string config;                                ///< argument of --config
  std::optional<std::uint16_t> again = {};           ///< port of the restart; nullopt: no restart
  std::optional<naiad::InheritedSockets> kept = {};  ///< sockets for every restart
  /// Sockets for the next restart only: the port stays open for players of a round that is handed over.
  std::optional<naiad::InheritedSockets> handed_over = {};
};

void inheritSockets(Start& start) {
  const auto sockets = naiad::InheritedSockets::importSockets();
  if (!sockets) return;
  naiad::useSockets(*sockets, start.options);
  if (sockets->is_service) start.kept = sockets->duplicate();
}

[[noreturn]] void runAgain(const Start& start) {
  if (const auto& sockets = start.kept ? start.kept : start.handed_over) sockets->exportToExec();
  start.command.run(*start.again);
}

void setOnReload(const Start& start, naiad::Host& host, naiad::LineLog& lines) {
  host.controls().setReload([&start, &lines] {
    naiad::HostOptions options = naiad::readHostOptions(start.command.argc(), start.command.argv().data());
    useLogOptions(options, lines);
    if (start.kept) naiad::useSockets(*start.kept, options);
    return options;
  });
}

void recordEnd(const naiad::Host& host, Start& start) {
  if (host.context().shutdown_scheduler.isRestart()) start.again = host.endpoint().port();
}

/// Like recordEnd(host, start), for a host that may hand over its rounds.
void recordEnd(const naiad::Host& host, const naiad::RoundHandover& handover, Start& start) {
  recordEnd(host, start);
  if (!host.controls().handsOverRound()) return;
  start.handed_over = handover.sockets();
  handover.exportRounds();
}

/// Serves a game whose worlds have their own processes. Only these load the game: in this process, its code
/// could read the server's key.
int serveWorlds(Start& start, naiad::LineLog& lines) {
  const naiad::LogLine log = [&lines](const naiad::LogEvent& event) { lines(event); };
  const naiad::HostOptions options = naiad::withUsableJournal(start.options, log);
  const auto module = naiad::GameModule::find(options.game);
  const auto launcher = naiad::launchModule(options, module.string(), start.config, log);
  const naiad::crash::Report crashes("dfserver", lines.descriptor());
  const naiad::LogLine print = markedLog(lines);
  const naiad::GameProbe preview = naiad::probeGame(*launcher, [&](const std::string& line) {
    print(line);
    if (!options.log_file.empty()) std::cerr << naiad::oneLine(line) << std::endl;
  });
  if (!preview.ready) return failPreview(preview.end);
  const std::string name = naiad::GameModule::nameOf(module);
  naiad::Host host(start.options, name, log);
  announce(options, host);
  naiad::HostOptions journaled = naiad::withFrameTime(options, *preview.ready);
  journaled.port = host.endpoint().port();  // a round continues on the port that its players know
  const auto journals = naiad::RoundJournals::open(journaled, name, module.string(), log);
  host.clients().setWorlds(naiad::startWorlds(launcher, host.context().feed.publishingGame(print), journals));
  setOnReload(start, host, lines);
  log("dfserver " + std::string(naiad::kVersion) + " hosts " + name + " on " + host.endpoint().address());
  df::World& world = df::World::current();
  setUp(world, *preview.ready);
  naiad::RoundHandover handover(start.command, {{"", journals}});
  if (journals) host.controls().setHandover(handover);
  host.run(world);
  recordEnd(host, handover, start);
  return host.clients().rooms().failure().empty() ? kOk : failGame(host.clients().rooms().failure());
}

/// Returns a log for lines of a room's game.
naiad::LogLine roomLog(naiad::LineLog& log, const std::string& room) {
  return [&log, room](const std::string& line) {
    log({"game", "game in " + room + ": " + line, {{"room", room}}});
  };
}

std::vector<naiad::RoomConfig> parseRooms(naiad::Host& host, const std::vector<naiad::LaunchedRoom>& launched,
                                          const std::vector<std::shared_ptr<naiad::RoundJournals>>& journals,
                                          naiad::LineLog& lines) {
  std::vector<naiad::RoomConfig> rooms;
  rooms.reserve(launched.size());
  for (std::size_t i = 0; i < launched.size(); ++i) {
    naiad::RoomConfig plan = launched[i].plan;
    if (journals[i] != nullptr) plan.resumes_round = journals[i]->resumeOptions().has_value();
    const naiad::LogLine print = host.context().feed.publishingGame(roomLog(lines, plan.name));
    plan.new_world = naiad::startWorlds(launched[i].launcher, print, journals[i]);
    rooms.push_back(std::move(plan));
  }
  return rooms;
}

/// Returns the rooms whose rounds are recorded.
std::vector<naiad::RoundHandover::Room> keptRooms(
    const std::vector<naiad::LaunchedRoom>& launched,
    const std::vector<std::shared_ptr<naiad::RoundJournals>>& journals) {
  std::vector<naiad::RoundHandover::Room> rooms;
  for (std::size_t i = 0; i < launched.size(); ++i) {
    if (journals[i] != nullptr) rooms.push_back({launched[i].plan.name, journals[i]});
  }
  return rooms;
}

/// Serves named rooms; each room's game has its own world processes.
int serveRooms(Start& start, naiad::LineLog& lines) {
  const naiad::LogLine log = [&lines](const naiad::LogEvent& event) { lines(event); };
  const naiad::HostOptions options = naiad::withUsableJournal(start.options, log);
  const auto print = [&](const std::string& room) { return roomLog(lines, room); };
  const std::vector<naiad::LaunchedRoom> launched = naiad::launchRooms(options, start.config, log, print);
  const naiad::crash::Report crashes("dfserver", lines.descriptor());
  naiad::Host host(start.options, launched.front().plan.game, log);
  announce(options, host);
  const auto journals = naiad::openRoomJournals(options, host.endpoint().port(), launched, log);
  host.clients().setRooms(parseRooms(host, launched, journals, lines));
  setOnReload(start, host, lines);
  log("dfserver " + std::string(naiad::kVersion) + " hosts " + std::to_string(launched.size()) +
      " rooms on " + host.endpoint().address());
  df::World& world = df::World::current();
  setUp(world, launched.front().plan.ready);
  naiad::RoundHandover handover(start.command, keptRooms(launched, journals));
  if (naiad::usesJournal(options)) host.controls().setHandover(handover);
  host.run(world);
  recordEnd(host, handover, start);
  return kOk;
}

int serve(Start& start) {
  naiad::HostOptions& options = start.options;
  if (const auto socket = naiad::takeWorldSocket()) {
    naiad::LineLog log("", naiad::LineLog::Writer::kCaller);
    df::World::current().setActivityPage(naiad::openWorldPage());
    naiad::WorldServer world(*socket, naiad::isGameOverPerPlayer(options));
    return play(naiad::GameModule(options.game), "", world, options, log,
                [&log](const naiad::LogEvent& event) { log(event); });  // the server adds time and "game: "
  }
  if (const int code = naiad::reportDeploymentProblems(options); code != 0) return code;
  if (const std::string problem = naiad::operatorPartsProblem(); !problem.empty())
    throw std::runtime_error("Cannot load the operator features (bans, scores, dfctl, metrics): " + problem);
  naiad::LineLog log(options.log_file);
  useLogOptions(options, log);
  if (!options.rooms.empty()) return serveRooms(start, log);
  if (!options.in_process) return serveWorlds(start, log);
  const naiad::crash::Report crashes("dfserver", log.descriptor());
  naiad::crash::setWorld(df::World::current());
  const naiad::GameModule game(options.game);
  naiad::Host host(options, game.name(), [&log](const naiad::LogEvent& event) { log(event); });
  setOnReload(start, host, log);
  announce(options, host);
  const ExitCode code = play(game, host.endpoint().address(), host, options, log,
                             host.context().feed.publishingGame(markedLog(log)));
  host.finish();
  recordEnd(host, start);
  return host.clients().rooms().failure().empty() ? code : failGame(host.clients().rooms().failure());
}

}  // namespace

int main(int argc, char** argv) {
  naiad::silenceParseErrors();
  naiad::ignoreBrokenPipes();
  naiad::HostOptions options;
  switch (naiad::parseHostOptions(argc, argv, options)) {
    case naiad::CommandLine::kDone:
      return kOk;
    case naiad::CommandLine::kUsageError:
      return kUsage;
    case naiad::CommandLine::kListGames:
      for (const std::string& name : naiad::GameModule::available()) std::cout << name << "\n";
      return kOk;
    case naiad::CommandLine::kRun:
      break;
  }
  Start start{naiad::ReexecCommand(argc, argv), options, naiad::configFileOf(argc, argv)};
  naiad::hidePassword(argc, argv);
  try {
    inheritSockets(start);
    const int code = serve(start);
    if (start.again) runAgain(start);
    return code;
  } catch (const naiad::GameError& error) {
    std::cerr << "dfserver: " << error.what() << "\n";
    return kNoGame;
  } catch (const naiad::ListenError& error) {
    std::cerr << "dfserver: " << naiad::listenErrorText(error, start.options) << "\n";
    return kCannotListen;
  } catch (const std::exception& error) {
    std::cerr << "dfserver: " << naiad::errorText(error) << "\n";
    return kFile;
  }
}
