// Reads a list of servers from the web: what dfserver --status-file writes, or an array of that.
//
// A list comes from strangers: it is read in bounded memory and depth, its texts are made safe, and a server
// counts only if it has a whole link.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/lan/FoundServers.h"

namespace naiad {

/// Nothing unless `json` is a JSON object or an array of objects (RFC 8259), of UTF-8, at most 8 levels deep.
/// Of an object name, game, players, max_players, password, protocol and link are read; numbers out of range
/// count as the nearest in it, members of another type as missing. Objects without a link that leads
/// somewhere are passed over. The list is cut as FoundServers cuts it.
std::optional<FoundServers> readServerList(std::string_view json);

}  // namespace naiad
