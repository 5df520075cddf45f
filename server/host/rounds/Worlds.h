// Starts worlds in processes of their own.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/rounds/Journals.h"
#include "host/settings/HostOptions.h"
#include "host/world/WorldLauncher.h"
#include "host/world/WorldMessages.h"

namespace naiad {

/// Does a key that ends the game end it for its player alone?
bool leavesAlone(const HostOptions& options);

/// What starts the worlds of dfserver with this module, whose path is absolute; this process does not load
/// it. `config`: the file of --config, or empty. `nice`: how far they stand back behind this process. Better
/// called before this process has threads and secrets; from then on its memory is closed to its worlds.
/// Throws std::system_error.
std::shared_ptr<const WorldLauncher> launchModule(const HostOptions& options, const std::string& module,
                                                  const std::string& config, const LogLine& log,
                                                  int nice = 0);
/// The same for this program, which is the game. `log_file`: the game's own.
std::shared_ptr<const WorldLauncher> launchProgram(const HostOptions& options, const std::string& log_file,
                                                   const LogLine& log);

/// For Host::setWorlds(). `print`: gets the lines that worlds print. They may have any bytes, and read as a
/// line of the server's own.
/// `journals`: write their rounds down; null: do not.
std::function<std::unique_ptr<Round>(asio::io_context& home)> startWorlds(
    std::shared_ptr<const WorldLauncher> launcher, LogLine print,
    std::shared_ptr<Journals> journals = nullptr);

/// The options with the length of a tick that the game asks for, unless they have one.
HostOptions withFrameTime(HostOptions options, const WorldReady& ready);

/// What executes worlds of this module again, with `program` (dfserver's path) in place of this one. They
/// read and write in `folder` alone, beside the game's own folders. Throws std::system_error.
std::shared_ptr<const WorldLauncher> launchAgain(const HostOptions& options, const std::string& module,
                                                 const std::string& program, const std::string& folder,
                                                 const std::vector<std::string>& variables);

/// Runs the game until GM.run(), in a world that is ended then. What it has set up; or how it ended before.
struct Preview {
  std::optional<WorldReady> ready;
  WorldEnd end;
};
Preview previewWorld(const WorldLauncher& launcher, const LogLine& print);

}  // namespace naiad
