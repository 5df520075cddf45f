// How many connections, and how many open files, a server has room for by its options.
#pragma once

#include <cstddef>

#include "host/settings/HostOptions.h"

namespace naiad {

/// Of clients: players, their next connections when they come back, and some that have not said hello.
std::size_t maxConnections(const HostOptions& options);

/// Connections that have not finished TLS. Those from prefixes that have players have places of their own, so
/// that a crowd of others does not keep players from coming back.
struct HalfOpenPlaces {
  std::size_t in_all = 0;
  std::size_t known = 0;  ///< of prefixes that have players
  std::size_t of_a_prefix = 0;
};
HalfOpenPlaces halfOpenPlaces(const HostOptions& options);

/// Files that may be open at once, of all kinds.
std::size_t wantedFiles(const HostOptions& options);

}  // namespace naiad
