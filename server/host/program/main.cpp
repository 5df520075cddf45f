// dfserver: loads a game, installs the host as its runner, and calls the game's main().
#include <google/protobuf/stubs/logging.h>

#include <exception>
#include <iostream>

#include "engine/managers/GameManager.h"
#include "engine/managers/LogManager.h"
#include "engine/world/World.h"
#include "host/auth/Seed.h"
#include "host/program/Announcement.h"
#include "host/program/GameModule.h"
#include "host/program/Host.h"
#include "host/program/HostOptions.h"
#include "host/program/LineLog.h"
#include "host/program/Worlds.h"
#include "host/world/WorldServer.h"
#include "host/world/WorldStart.h"
#include "shared/values/Version.h"

namespace {

enum ExitCode { kOk = 0, kGameFailed = 1, kUsage = 2, kNoGame = 3, kCannotListen = 4, kFile = 5 };

/// What games reach the host by; taken back however the game ends, for their statics outlive the host.
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

/// What is the same for a host and for a world that it has started in another process; `where` it is.
ExitCode play(const naiad::GameModule& game, const std::string& where, df::Runner& runner,
              naiad::HostOptions& options, naiad::LineLog& log) {
  if (options.seed == 0) options.seed = static_cast<std::int64_t>(naiad::newSeed());
  for (const std::string& folder : game.resourceFolders()) df::World::current().addResourceFolder(folder);
  const Installed installed(runner, [&log](const std::string& line) { log(line); });
  GM.setSeed(static_cast<std::uint64_t>(options.seed));
  for (const std::string& folder : game.resourceFolders()) df::World::current().addResourceFolder(folder);
  log("dfserver " + std::string(naiad::kVersion) + " hosts " + game.name() + where + ", seed " +
      std::to_string(options.seed));
  return play(game);
}

int serve(naiad::HostOptions options) {
  naiad::LineLog log(options.log_file);
  const naiad::GameModule game(options.game);
  if (const auto socket = naiad::takeWorldSocket()) {
    naiad::WorldServer world(*socket, naiad::leavesAlone(options));
    return play(game, " in a world of its own", world, options, log);
  }
  naiad::Host host(options, game.name(), [&log](const std::string& line) { log(line); });
  if (naiad::wantsWorlds(options)) host.setWorlds(naiad::startWorlds());
  naiad::writeWhereabouts(options, host);
  for (const std::string& line : naiad::howToJoin(host)) std::cout << line << std::endl;
  const ExitCode code = play(game, " on " + host.address(), host, options, log);
  if (host.failure().empty()) return code;
  std::cerr << "dfserver: the game " << host.failure() << "\n";
  return kGameFailed;
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
