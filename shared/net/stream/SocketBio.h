// OpenSSL's way to a non-blocking socket. Its own BIO for sockets raises SIGPIPE, and cannot be asked why it
// failed.
#pragma once

#include <optional>

#include "shared/net/stream/ClientHelloGuard.h"

struct bio_st;

namespace naiad {

/// Must outlive the BIO and stay where it is.
struct SocketBio {
  int socket = -1;                        ///< connected, non-blocking; not owned
  bool ended = false;                     ///< the peer closed its side
  bool failed = false;                    ///< the socket did
  bool refused = false;                   ///< `guard` did
  std::optional<ClientHelloGuard> guard;  ///< while set, sees what comes in

  /// A BIO on this, for SSL_set_bio(); null if out of memory.
  bio_st* make();
};

}  // namespace naiad
