// The next round of a game that keeps its state in globals: this program, run anew in this process.
//
// Sockets are closed meanwhile; clients find the server again at the same port, by themselves.
#pragma once

#include <cstdint>
#include <optional>

namespace naiad {

/// The port that the round before had; nothing in the first one.
std::optional<std::uint16_t> portOfLastRound();

/// Replace this process by one that was started as it was: same program, arguments, environment, and working
/// directory as when this library was loaded. No destructors run. Returns only if that cannot be done.
void startNextRound(std::uint16_t port);

/// Do that when the process exits with code 0, unless this is called again with nothing.
void startNextRoundAtExit(std::optional<std::uint16_t> port);

}  // namespace naiad
