// Numbers of connections and open files that a server allows, from its options.
#pragma once

#include <cstddef>

#include "host/settings/HostOptions.h"

namespace naiad {

/// Maximum number of client connections: players, their reconnections, and some without a hello yet.
std::size_t maxConnections(const HostOptions& options);

/// Limits of connections that have not finished TLS. Prefixes with players have their own places, so that a
/// flood from others does not stop players from reconnecting.
struct HalfOpenPlaces {
  std::size_t in_all = 0;
  std::size_t known = 0;  ///< from prefixes with players
  std::size_t of_a_prefix = 0;
};
HalfOpenPlaces halfOpenPlaces(const HostOptions& options);

/// Number of files of all kinds that may have to be open at once.
std::size_t wantedFiles(const HostOptions& options);

}  // namespace naiad
