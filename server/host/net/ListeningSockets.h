// The sockets by which this process is reached, for a program that it runs next in its own place.
#pragma once

#include <cstdint>
#include <optional>

#include "host/net/InheritedSockets.h"

namespace naiad {

/// Copies of the socket that listens on this TCP port and of the one for datagrams on the same address, which
/// stay open when those are closed; the caller's to close. Nothing if this process does not have both, as
/// without encryption. Reads /proc.
std::optional<InheritedSockets> copyListeningSockets(std::uint16_t port);

}  // namespace naiad
