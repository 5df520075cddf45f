// Starts the launchers (WorldLauncher.h) of rooms, and opens the rooms' journals.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/rounds/RoomConfig.h"
#include "host/rounds/RoundJournals.h"
#include "host/settings/HostOptions.h"
#include "host/world/WorldLauncher.h"
#include "shared/program/LineLog.h"

namespace naiad {

struct LaunchedRoom {
  RoomConfig plan;  ///< all members except new_world and resumes_round
  std::shared_ptr<const WorldLauncher> launcher;
};

/// Starts the launchers of rooms. Each game runs until GM.run(), in a world that is then ended; `print`
/// returns the log for a room's output. Call it, if possible, before this process has threads and secrets.
/// Throws GameError for a game that is missing or does not reach GM.run(), or std::system_error.
std::vector<LaunchedRoom> launchRooms(const HostOptions& options, const std::string& config,
                                      const LogLine& log,
                                      const std::function<LogLine(const std::string& room)>& print);

/// Opens the journals of a server's rooms, in their order: a folder for each below that of --journal, and one
/// thread to write them. Null if the options disable journals. `port`: the server's port; a round is resumed
/// only on the port where it began. Throws std::system_error if the folder of --journal cannot be made.
std::vector<std::shared_ptr<RoundJournals>> openRoomJournals(const HostOptions& options, std::uint16_t port,
                                                             const std::vector<LaunchedRoom>& rooms,
                                                             const LogLine& log);

}  // namespace naiad
