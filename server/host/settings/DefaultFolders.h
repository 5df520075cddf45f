// Default paths of dfserver's control socket, state and recorded rounds.
#pragma once

#include <string_view>

#include "host/settings/HostOptions.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// Value of an option that disables its file or folder, in place of a path.
inline constexpr std::string_view kOffWord = "off";

/// Fills in dfserver's default paths. Games that are programs themselves have no such defaults.
void useDefaultFolders(HostOptions& options);

/// Makes a server without encryption listen on loopback only, unless an address other than "::" was given.
void defaultToLoopback(HostOptions& options);

/// Returns the options to start worlds with. If the default journal folder cannot be created or written, logs
/// a warning and turns the journal off. A folder given by an option stays, and fails where it is used.
HostOptions withUsableJournal(HostOptions options, const LogLine& log);

}  // namespace naiad
