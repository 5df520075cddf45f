// Numbers of connections and open files that a server allows, from its options.
#pragma once

#include <cstddef>

#include "host/settings/HostOptions.h"

namespace naiad {

/// Maximum number of client connections: players, their reconnections, and some connections without a hello.
std::size_t maxConnections(const HostOptions& options);

/// Limits of connections that have not finished the TLS handshake. Prefixes with players have places of their
/// own, so that a flood from other prefixes does not stop players from reconnecting.
struct HalfOpenQuota {
  std::size_t total = 0;
  std::size_t known = 0;  ///< places for prefixes with players, in addition to `total`
  std::size_t per_prefix = 0;
};
HalfOpenQuota halfOpenQuota(const HostOptions& options);

/// Number of files of all kinds that may have to be open at once.
std::size_t requiredOpenFiles(const HostOptions& options);

}  // namespace naiad
