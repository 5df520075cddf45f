// What a TLS handshake proved about the server at the other end. Whether that is enough is the client's
// decision.
#pragma once

#include <string>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

struct PeerFacts {
  Fingerprint key;              ///< of the key that the server proved to hold
  bool chain_verifies = false;  ///< its certificate is for this host name and from an authority trusted here
  std::string chain_problem;    ///< why not, in OpenSSL's words ("self-signed certificate"); empty if it is
};

}  // namespace naiad
