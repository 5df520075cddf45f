// Starts worlds in processes of their own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/rounds/RoundJournals.h"
#include "host/settings/HostOptions.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldMessages.h"

namespace naiad {

/// True if a key that ends the game ends it only for the player pressing it.
bool isGameOverPerPlayer(const HostOptions& options);

/// Starts the launcher of worlds with this module, whose path is absolute; this process does not load it.
/// `config`: the file of --config, or empty. `nice`: added to the worlds' nice value. Call it, if possible,
/// before this process has threads and secrets. With a sandbox, worlds cannot read this process's memory
/// afterwards. Throws std::system_error.
std::shared_ptr<const WorldLauncher> launchModule(const HostOptions& options, const std::string& module,
                                                  const std::string& config, const LogLine& log,
                                                  int nice = 0);
/// Like launchModule(), for a game that is this program. `log_file`: the game's log file.
std::shared_ptr<const WorldLauncher> launchProgram(const HostOptions& options, const std::string& log_file,
                                                   const LogLine& log);

/// Returns the function for Host::setWorlds(). `print` gets the lines that worlds print, which may have any
/// bytes and look like lines of the server. `journals` record their rounds; null: they are not recorded.
std::function<std::unique_ptr<Round>(asio::io_context& home)> startWorlds(
    std::shared_ptr<const WorldLauncher> launcher, LogLine print,
    std::shared_ptr<RoundJournals> journals = nullptr);

/// Returns the options with the tick length that the game asks for, unless they have one.
HostOptions withFrameTime(HostOptions options, const WorldReady& ready);

/// Starts the launcher of replays of this module, with `program` (dfserver's path) in place of this one.
/// Worlds read the files of makeSandboxPolicy(), and write only in `folder`. `variables` ("NAME=value")
/// replace the game's variables (isGameVariable). Throws std::system_error.
std::shared_ptr<const WorldLauncher> launchReplay(const HostOptions& options, const std::string& module,
                                                  const std::string& program, const std::string& folder,
                                                  const std::vector<std::string>& variables);

/// The settings of a game at GM.run(), or how it ended before.
struct GameProbe {
  std::optional<WorldReady> ready;
  WorldEnd end;
};
/// Starts the game and ends it again. Calls `print` with its lines only if it does not reach GM.run().
GameProbe probeGame(const WorldLauncher& launcher, const LogLine& print);

}  // namespace naiad
