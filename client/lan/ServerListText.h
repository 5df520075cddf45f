// A list of servers for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "client/lan/FoundServers.h"

namespace naiad {

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
