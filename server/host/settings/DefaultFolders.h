// Where dfserver keeps things if no option says: its control socket, its state, and the rounds that it writes
// down.
#pragma once

#include <string_view>

#include "host/settings/HostOptions.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// In place of a path: there is to be none.
inline constexpr std::string_view kOffWord = "off";

/// Fill in what dfserver does where these options do not say. Games that are programs themselves have no such
/// folders.
void useDefaultFolders(HostOptions& options);

/// Without encryption a server is on loopback, unless an address was given.
void keepHome(HostOptions& options);

/// The options to start worlds with: these, without a journal if its default folder cannot be made or
/// written, which the log says then. A folder that was asked for is left to fail where it is used.
HostOptions withUsableJournal(HostOptions options, const LogLine& log);

}  // namespace naiad
