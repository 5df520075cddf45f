// What the disk of a test notes of each sync of a round's file.
#pragma once

#include <cstdint>

namespace naiad {

struct SyncNote {
  std::int64_t began = 0;  ///< CLOCK_MONOTONIC, ns
  std::int64_t ended = 0;
  std::int64_t size = 0;  ///< of the file, when it began: survives a power cut once it has ended
};

}  // namespace naiad
