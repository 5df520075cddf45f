// dfserver: loads a game, installs the host as its runner, and calls the game's main().
#include <google/protobuf/stubs/logging.h>

#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <random>

#include "GameManager.h"
#include "GameModule.h"
#include "Host.h"
#include "HostOptions.h"
#include "LogManager.h"
#include "Version.h"
#include "World.h"

namespace {

enum ExitCode { kOk = 0, kGameFailed = 1, kUsage = 2, kNoGame = 3, kCannotListen = 4, kFile = 5 };

/// Log lines with the time of day, to a file or stderr.
class LineLog {
 public:
  explicit LineLog(const std::string& path) {
    if (path.empty()) return;
    m_file.open(path, std::ios::app);
    if (!m_file) throw std::runtime_error("The log file " + path + " cannot be written.");
  }
  void operator()(const std::string& line) {
    const std::time_t now = std::time(nullptr);
    char time[32];
    std::strftime(time, sizeof time, "%Y-%m-%d %H:%M:%S ", std::localtime(&now));
    (m_file.is_open() ? m_file : std::cerr) << time << line << std::endl;
  }

 private:
  std::ofstream m_file;
};

/// What games reach the host by; taken back however the game ends, for their statics outlive the host.
struct Installed {
  Installed(naiad::Host& host, const naiad::Host::Log& log) {
    LM.setSink(log);
    GM.setRunner(&host);
  }
  ~Installed() {
    GM.setRunner(nullptr);
    LM.setSink({});
  }
  Installed(const Installed&) = delete;
  Installed& operator=(const Installed&) = delete;
};

/// Play. A game that throws failed; its exception is none of ours.
ExitCode play(const naiad::GameModule& game) {
  try {
    const int result = game.main();
    if (result == 0) return kOk;
    std::cerr << "dfserver: the game ended with code " << result << "\n";
  } catch (const std::exception& error) {
    std::cerr << "dfserver: the game failed: " << error.what() << "\n";
  } catch (...) {
    std::cerr << "dfserver: the game failed\n";
  }
  return kGameFailed;
}

std::uint64_t newSeed() {
  std::random_device device;
  return 1 + ((static_cast<std::uint64_t>(device()) << 21) ^ device()) % 9'000'000'000'000'000;
}

int serve(naiad::HostOptions options) {
  LineLog log(options.log_file);
  const naiad::GameModule game(options.game);
  naiad::Host host(options, game.name(), [&log](const std::string& line) { log(line); });
  if (!options.port_file.empty()) {
    std::ofstream file(options.port_file);
    if (!(file << host.port() << std::endl)) {
      throw std::runtime_error("The port file " + options.port_file + " cannot be written.");
    }
  }
  if (options.seed == 0) options.seed = static_cast<std::int64_t>(newSeed());
  const Installed installed(host, [&log](const std::string& line) { log(line); });
  GM.setSeed(static_cast<std::uint64_t>(options.seed));
  for (const std::string& folder : game.resourceFolders()) df::World::current().addResourceFolder(folder);
  log("dfserver " + std::string(naiad::kVersion) + " hosts " + game.name() + " on " + host.address() +
      ", seed " + std::to_string(options.seed));
  if (!options.join_file.empty()) {
    std::ofstream file(options.join_file);
    if (!(file << host.joinArguments() << std::endl)) {
      throw std::runtime_error("The join file " + options.join_file + " cannot be written.");
    }
  }
  std::cout << "Join from this machine with: dfclient " << host.joinArguments() << std::endl;
  if (const auto fingerprint = host.fingerprint()) {
    std::cout << "From elsewhere with its name or address; its key is " << fingerprint->text() << std::endl;
  }
  return play(game);
}

}  // namespace

int main(int argc, char** argv) {
  // The library would complain on stderr about every string that a stranger sends in bad UTF-8.
  google::protobuf::SetLogHandler(nullptr);
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
  try {
    return serve(options);
  } catch (const naiad::GameError& error) {
    std::cerr << "dfserver: " << error.what() << "\n";
    return kNoGame;
  } catch (const naiad::ListenError& error) {
    std::cerr << "dfserver: " << error.what() << "\n";
    return kCannotListen;
  } catch (const std::exception& error) {
    std::cerr << "dfserver: " << error.what() << "\n";
    return kFile;
  }
}
