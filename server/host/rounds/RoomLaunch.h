// Starts what the worlds of rooms are started from.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/rounds/Journals.h"
#include "host/rounds/RoomPlan.h"
#include "host/settings/HostOptions.h"
#include "host/world/WorldLauncher.h"
#include "shared/program/LineLog.h"

namespace naiad {

struct LaunchedRoom {
  RoomPlan plan;  ///< without new_world
  std::shared_ptr<const WorldLauncher> launcher;
};

/// The rooms of these options. Each game runs until GM.run(), in a world that is ended then; `print` makes
/// what gets its lines in a room. Better called before this process has threads and secrets. Throws GameError
/// for a game that does not come so far, or std::system_error.
std::vector<LaunchedRoom> launchRooms(const HostOptions& options, const std::string& config,
                                      const LogLine& log,
                                      const std::function<LogLine(const std::string& room)>& print);

/// The journals of a server's rooms: a folder for each below that of --journal, and one thread that writes
/// them. In the order of the rooms; null pointers if the options want no journals. `port`: by which players
/// join: a round goes on where they look for it. Throws std::system_error if there can be no such folder.
std::vector<std::shared_ptr<Journals>> openRoomJournals(const HostOptions& options, std::uint16_t port,
                                                        const std::vector<LaunchedRoom>& rooms,
                                                        const LogLine& log);

}  // namespace naiad
