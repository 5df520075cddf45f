// The journals of a server's rooms: a folder for each below that of --journal, and one thread that writes
// them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/rounds/Journals.h"
#include "host/rounds/RoomLaunch.h"
#include "host/settings/HostOptions.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// In the order of the rooms; null pointers if the options want no journals. `port`: by which players join: a
/// round goes on where they look for it. Throws std::system_error if there can be no such folder.
std::vector<std::shared_ptr<Journals>> openRoomJournals(const HostOptions& options, std::uint16_t port,
                                                        const std::vector<LaunchedRoom>& rooms,
                                                        const LogLine& log);

}  // namespace naiad
