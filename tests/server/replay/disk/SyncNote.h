// The record that a test's disk writes for each sync of a round's file.
#pragma once

#include <cstdint>

namespace naiad {

struct SyncNote {
  std::int64_t began = 0;  ///< CLOCK_MONOTONIC, ns
  std::int64_t ended = 0;
  std::int64_t size = 0;  ///< file size at `began`; this much survives a power cut after `ended`
};

}  // namespace naiad
