// What has to hold of every snapshot that a client takes in, whoever wrote it.
#pragma once

#include <cstdint>
#include <string_view>

#include "shared/replica/Replica.h"

namespace naiad::fuzz {

/// Read a snapshot and, if it is well-formed, require: what came out is in its ranges, says the same when
/// written again, and does no harm when it is applied (twice). `again`: read it once more.
void receiveAndCheck(Replica& replica, std::string_view received, bool again);
/// The picture at `tick` is of the size of the view.
void drawAndCheck(const Replica& replica, std::uint32_t tick);

}  // namespace naiad::fuzz
