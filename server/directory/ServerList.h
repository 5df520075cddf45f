// A list of servers for the web, as dfclient --list-url reads it: an array of what dfserver --status-file
// writes.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "shared/fleet/BusPayloads.h"

namespace naiad {

/// Servers in a list; with all of them it stays below the 1 MiB that a client takes.
inline constexpr std::size_t kMaxListedServers = 500;

/// The link to a server, or to a room of it; empty if it is not known where it is, or which key it has.
std::string linkOf(const Presence& server, const std::string& room = "");

/// A JSON array (RFC 8259), one object to a line, ASCII: the servers that let players in and have a link. If
/// there are too many, those with most free places; rooms are left out of what would be too long with them.
std::string serverListText(std::vector<Presence> servers);

}  // namespace naiad
