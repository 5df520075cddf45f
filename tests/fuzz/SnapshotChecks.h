// Requirements for every snapshot that a client accepts, whatever program wrote it.
#pragma once

#include <cstdint>
#include <string_view>

#include "shared/replica/Replica.h"

namespace naiad::fuzz {

/// Reads a snapshot and, if it is valid, requires that its values are in range, that it survives being
/// written and read again, and that applying it twice is harmless. `again`: reads it once more.
void receiveAndCheck(Replica& replica, std::string_view received, bool again);
/// Requires that the picture at `tick` has the size of the view.
void drawAndCheck(const Replica& replica, std::uint32_t tick);

}  // namespace naiad::fuzz
