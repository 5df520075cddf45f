// A list of servers for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/lan/FoundServers.h"

namespace naiad {

/// Reads a list of servers from the web: what dfserver --status-file writes, or an array of that.
///
/// A list comes from strangers: it is read in bounded memory and depth, its texts are made safe, and a server
/// counts only if it has a whole link.
/// Nothing unless `json` is a JSON object or an array of objects (RFC 8259), of UTF-8, at most 8 levels deep.
/// Of an object name, game, players, max_players, password, protocol and link are read; numbers out of range
/// count as the nearest in it, members of another type as missing. Objects without a link that leads
/// somewhere are passed over. The list is cut as FoundServers cuts it.
std::optional<FoundServers> readServerList(std::string_view json);

/// What to do where no server was found: sentences for people.
inline constexpr const char* kNoServersFound[] = {
    "No server answered in this network.",
    "Start one here: dfserver --game NAME. Join one elsewhere: dfclient HOST[:PORT], or its link."};

/// "3/16", and what else is to be known before joining: "password", "full", "version 5".
std::string placesOf(const FoundServer& server);
std::string noteOf(const FoundServer& server);

/// A line for each, in columns, and a head; a sentence if there is none.
std::string serversAsText(const std::vector<FoundServer>& servers);
/// A JSON array of objects (docs/doors.md lists their members), one to a line. ASCII only.
std::string serversAsJson(const std::vector<FoundServer>& servers);

}  // namespace naiad
