#include "host/program/ProgramHost.h"

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "engine/managers/Config.h"
#include "engine/world/LogFile.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "host/auth/Seed.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostEndpoint.h"
#include "host/process/CrashReport.h"
#include "host/process/ReexecCommand.h"
#include "host/program/Announcement.h"
#include "host/program/LocalClient.h"
#include "host/rounds/WorldFactory.h"
#include "host/world/WorldServer.h"
#include "host/world/WorldStart.h"
#include "proto/ParseErrors.h"
#include "shared/program/LogText.h"
#include "shared/program/ProcessSetup.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

namespace fs = std::filesystem;

enum ExitCode { kGameFailed = 1, kUsage = 2, kCannotListen = 4, kFile = 5 };

constexpr std::chrono::seconds kLogTime{1};  ///< maximum time to write log lines at the end

const AccessHints kOpenness{
    "NAIAD_PUBLIC=1 in the environment, or public:true, in df-config.txt, allows others.",
    "NAIAD_ADDRESS=127.0.0.1 in the environment restricts it to this machine."};

std::string programName() {
  return program_invocation_short_name;
}

bool g_failed = false;  ///< true if fail() has already printed the reason

[[noreturn]] void fail(ExitCode code, const std::string& sentence) {
  g_failed = true;
  LineLog::waitUntilWritten(kLogTime);
  std::cerr << programName() << ": " << sentence << std::endl;
  std::exit(code);
}

/// Prints a line that a world has printed, as if the game ran here. Drops it if printing would block.
void printLine(const std::string& line) {
  std::cout.flush();
  pollfd ready{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&ready, 1, 0) != 1) return;
  const std::string text = oneLine(line) + "\n";
  [[maybe_unused]] const ssize_t written = write(STDOUT_FILENO, text.data(), text.size());
}

std::string configFile() {
  const char* p_named = std::getenv("DRAGONFLY_CONFIG");
  return p_named != nullptr ? p_named : df::CONFIG_FILENAME;
}

/// Returns "df-config.txt:3: port", for error messages; without the line number if the key is not found.
std::string placeInConfig(const std::string& key) {
  std::string place = configFile();
  std::ifstream lines(place);  // a regular file, or there would be no key
  const std::string wanted = "," + key + ":";
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    line.insert(0, 1, ',');  // so every key follows a comma
    if (!line.starts_with(",#") && line.find(wanted) != std::string::npos)
      return place.append(":").append(std::to_string(number)).append(": ").append(key);
  }
  return place.append(": ").append(key);
}

/// Adds folders to search for sprites and sounds after the working directory: the program's folder and its
/// parent, because many games are built in a subfolder.
void addFolders(df::World& world) {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return;
  world.extras().resources.addFolder(folder.string());
  world.extras().resources.addFolder(folder.parent_path().string());
}

/// Opens the port of the options; if that fails and no option set the port, opens any free one.
std::unique_ptr<Host> openHost(HostOptions options, bool port_given, const Host::Log& log) {
  try {
    return std::make_unique<Host>(options, programName(), log);
  } catch (const ListenError&) {
    if (port_given) throw;
  }
  options.port = 0;
  return std::make_unique<Host>(options, programName(), log);
}

/// Adds lines to the help screen of clients.
void addToHelp(df::World& world, const std::vector<std::string>& lines) {
  std::vector<std::string> help = world.getHelp();
  for (const std::string& line : lines) {
    for (std::size_t begin = 0; begin < line.size(); begin += kMaxHelpLength) {
      help.push_back(line.substr(begin, kMaxHelpLength));
    }
  }
  world.setHelp(std::move(help));
}

/// The client in the terminal, if there is one. Its end ends the game as soon as no other player is
/// connected, unless it failed. The end of the game ends the client.
class TerminalPlayer {
 public:
  TerminalPlayer(Host& host, const HostOptions& options, const std::string& log_file,
                 const df::WorldLog::Sink& log)
      : m_host(host), m_log(log) {
    if (!options.local_client || !LocalClient::hasTerminal()) return;
    const auto program = LocalClient::findProgram();
    if (!program) {
      std::cout << "Cannot play in this terminal: dfclient not found (NAIAD_CLIENT can name it)."
                << std::endl;
      return;
    }
    std::vector<std::string> arguments{"--attached", "--no-resume"};
    std::istringstream words(host.endpoint().joinArguments());
    for (std::string word; words >> word;) arguments.push_back(word);
    try {
      m_client.emplace(*program, arguments, options.password, log_file);
      m_host.clients().rooms().setEndsWithLast(true);
    } catch (const std::system_error& error) {
      std::cout << error.what() << std::endl;
    }
  }

  /// Ends the client. If there is another run, other players stay connected until then, without a goodbye.
  ~TerminalPlayer() {
    if (m_client && m_host.awaitsRun()) m_client->end();
  }
  TerminalPlayer(const TerminalPlayer&) = delete;
  TerminalPlayer& operator=(const TerminalPlayer&) = delete;

  /// Call once a tick.
  void update() {
    if (m_client && m_client->hasEnded()) endClient();
    if (m_local_left && m_host.clients().sessions().connectedCount() == 0) m_host.stop("The game is over.");
  }

 private:
  void endClient() {
    const bool failed = m_client->hasFailed();
    m_client.reset();
    m_host.clients().rooms().setEndsWithLast(false);
    m_local_left = !failed;
    if (failed) {
      std::cout << "The client failed; the game continues as a server. Ctrl-C stops it." << std::endl;
    } else if (const std::size_t others = m_host.clients().sessions().connectedCount(); others > 0) {
      std::cout << others << " still playing: the server stops when they have left, or with Ctrl-C."
                << std::endl;
    }
    m_log(failed ? "the client in the terminal failed" : "the client in the terminal has left");
  }

  Host& m_host;
  df::WorldLog::Sink m_log;
  std::optional<LocalClient> m_client;
  bool m_local_left = false;
};

/// Sends the game's log lines to its own file, as without a host, and to `dfctl watch`.
class WatchedLog {
 public:
  WatchedLog(df::World& world, Host& host) : m_world(world) {
    const LogLine log = host.context().feed.publishingGame([&world](const std::string& line) {
      df::writeToLogFile(df::Config::getInstance().getLogFile(), line, world.log().flush());
    });
    world.log().setSink([log](const std::string& line) { log(line); });
  }
  ~WatchedLog() { m_world.log().setSink({}); }
  WatchedLog(const WatchedLog&) = delete;
  WatchedLog& operator=(const WatchedLog&) = delete;

 private:
  df::World& m_world;
};

/// Executes the program again in this process, so that the game's static variables start afresh.
[[noreturn]] void beginAgain(std::unique_ptr<Host>& host) {
  const std::uint16_t port = host->endpoint().port();
  host.reset();
  LineLog::waitUntilWritten(kLogTime);
  std::cout.flush();
  ReexecCommand::ofProcess().run(port);
}

/// Prints why the program ended without a proper end, so that beginners do not just see a silent shell.
void reportEnd() {
  if (g_failed) return;
  if (crash::inTick()) {
    std::cerr << programName() << ": exit() was called" << crash::where()
              << "; use GM.setGameOver() to end a game" << std::endl;
  } else if (!df::World::current().hasBegun()) {
    std::cerr << programName() << ": the program ended without GM.run(), so nothing was played" << std::endl;
  }
}

ProgramHost g_program;
[[maybe_unused]] const bool g_installed = (df::running::setProgram(&g_program), true);

}  // namespace

void ProgramHost::startUp(df::World& world) {
  m_started = true;
  silenceParseErrors();
  const df::Config& config = df::Config::getInstance();
  m_options = {};
  m_options.name = programName();
  m_options.headless = config.getHeadless();
  try {
    m_given = readProgramOptions([&config](const std::string& key) { return config.match(key); }, m_options,
                                 placeInConfig);
  } catch (const OptionError& error) {
    fail(kUsage, error.what());
  }
  if (m_given.count("password") > 0 && std::getenv("NAIAD_PASSWORD") == nullptr)
    warnIfReadable(configFile(), m_options);
  if (const auto socket = takeWorldSocket()) {
    m_world_socket = socket;
    df::disableLogTruncation();
    world.setActivityPage(openWorldPage());
  } else {
    static const crash::Report crashes(programName(), -1);
    crash::setWorld(world);
    static const bool registered = std::atexit([] { reportEnd(); }) == 0;
    static_cast<void>(registered);
  }
  if (!m_options.headless) ignoreBrokenPipes();
  addFolders(world);
  seed(world);
  world.log().write("Naiad " + std::string(kVersion) + ", compat " + (world.compat() ? "on" : "off") +
                    (m_options.headless ? ", headless" : ""));
}

// Seeds the engine's random numbers: by an option or the host, else by a random_seed above 0, else anew in
// each run; headless runs with random_seed -1 repeat. rand() gets that seed, but with random_seed -1 only if
// an option or the host set it.
void ProgramHost::seed(df::World& world) const {
  const int random_seed = df::Config::getInstance().getRandomSeed();
  std::uint64_t seed = takeWorldSeed().value_or(static_cast<std::uint64_t>(m_options.seed));
  if (seed == 0 && random_seed > 0) seed = static_cast<std::uint64_t>(random_seed);
  const bool wanted = seed != 0;
  if (!wanted && m_options.headless && random_seed < 0) return;
  if (!wanted) seed = newSeed();
  world.setSeed(seed);
  world.log().write("seed " + std::to_string(seed));
  if (wanted || random_seed == 0) std::srand(static_cast<unsigned>(seed));
}

void ProgramHost::run(df::World& world) {
  if (!m_started) fail(kGameFailed, "GM.run() was called before GM.startUp(), which reads the settings");
  if (m_stopped) return world.setGameOver();
  // A world process has one run: if its game calls run() again, the game is over.
  if (m_world_socket)
    return WorldServer(std::exchange(*m_world_socket, -1), isGameOverPerPlayer(m_options)).run(world);
  if (m_options.headless) return runHeadless(world);
  try {
    serve(world);
  } catch (const ListenError& error) {
    fail(kCannotListen, listenErrorText(error, m_options));
  } catch (const std::exception& error) {
    fail(kFile, errorText(error));
  }
  // If players have left or a signal has stopped the server, the game ends, whatever its main() does.
  m_stopped = !world.isGameOver();
}

void ProgramHost::runHeadless(df::World& world) {
  for (; !world.isGameOver() && (m_options.ticks == 0 || m_ticks < m_options.ticks); ++m_ticks) {
    crash::setTick(static_cast<std::uint64_t>(world.getStepCount()) + 1);
    world.tick();
    crash::setTick(0);
  }
}

void ProgramHost::serve(df::World& world) {
  std::shared_ptr<LineLog> lines = std::move(m_lines);
  std::unique_ptr<Host> host = std::move(m_waiting);
  const bool is_first = host == nullptr;
  if (is_first && (!m_options.log_file.empty() || !LocalClient::hasTerminal()))
    lines = std::make_shared<LineLog>(m_options.log_file);
  // If a client uses the terminal and no log file is set, the host logs to the file of the game.
  const Host::Log log = [lines, &world](const LogEvent& event) {
    lines ? (*lines)(event) : world.log().write(event.text);
  };
  std::shared_ptr<const WorldLauncher> launcher;
  if (usesWorldProcesses(m_options))
    launcher = launchProgram(m_options, df::Config::getInstance().getLogFile(), log);
  const crash::Report crashes(programName(), lines ? lines->descriptor() : -1);
  if (const auto sockets = InheritedSockets::importSockets()) useSockets(*sockets, m_options);
  if (is_first) host = openHost(m_options, m_given.count("port") > 0 || m_options.sockets, log);
  const std::vector<std::string> how = joinInstructions(host->endpoint(), m_options, kOpenness);
  if (is_first) {
    writeEndpointFiles(m_options, host->endpoint());
    log(programName() + " listens on " + host->endpoint().address());
    for (const std::string& line : how) std::cout << line << std::endl;
    for (const std::string& line : qrLines(m_options)) std::cout << line << std::endl;
    std::cout << "Compatible with the published engine: " << (world.compat() ? "yes (compat)" : "no")
              << std::endl;
  }
  const std::vector<std::string> help = world.getHelp();
  addToHelp(world, how);

  if (launcher != nullptr) {
    HostOptions journaled = m_options;
    journaled.port = host->endpoint().port();  // a round continues on the port that its players know
    const auto journals = RoundJournals::open(journaled, programName(), "", log);
    host->clients().setWorlds(
        startWorlds(launcher, host->context().feed.publishingGame(printLine), journals));
  }
  TerminalPlayer terminal_player(*host, m_options, df::Config::getInstance().getLogFile(), log);
  host->setObserver([&terminal_player](df::World&) { terminal_player.update(); });
  {
    std::optional<WatchedLog> watched;
    if (lines) watched.emplace(world, *host);  // without `lines`, the host's own lines would appear twice
    host->run(world);
  }
  world.setHelp(help);
  if (host->context().shutdown_scheduler.isRestart()) beginAgain(host);
  if (!host->clients().rooms().failure().empty())
    fail(kGameFailed, "the game " + host->clients().rooms().failure());
  if (!host->awaitsRun()) return;
  // The handler runs before those of libraries that the host uses, because theirs were registered earlier.
  static const bool registered = std::atexit([] { g_program.finish(); }) == 0;
  static_cast<void>(registered);
  m_lines = std::move(lines);
  m_waiting = std::move(host);
}

void ProgramHost::finish() {
  if (m_waiting == nullptr) return;
  m_waiting->finish();
  m_waiting.reset();
  m_lines.reset();
}

}  // namespace naiad
