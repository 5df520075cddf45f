// The text of --status-file: the server's status, for server lists on the web.
//
// It contains no names of players and no address except the public one (--public-host).
#pragma once

#include <string>

#include "shared/fleet/ServerInfo.h"

namespace naiad {

/// Returns one line of ASCII JSON: name, game, players, max_players, password, protocol, version, and link.
/// `link`: a link for players on other machines; omitted if empty.
std::string statusText(const ServerInfo& facts, const std::string& link);

}  // namespace naiad
