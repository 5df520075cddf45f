#include "host/program/Worlds.h"

#include "host/world/WorldProcess.h"
#include "host/world/WorldStart.h"

namespace naiad {

bool wantsWorlds(const HostOptions& options) {
  return options.on_game_over == "restart" || options.players == "private";
}

bool leavesAlone(const HostOptions& options) {
  return options.on_game_over != "exit";
}

Host::NewWorld startWorlds() {
  return
      [](asio::io_context& home) { return std::make_unique<WorldProcess>(home, startThisProgramAsWorld()); };
}

}  // namespace naiad
