// The looks that were published lately: which of them recur, and one copy of each in memory.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "host/snapshot/PublishedModel.h"

namespace naiad {

class LookCatalogue {
 public:
  /// The model has a new look: compute its sum, find out whether it recurs, and share its memory.
  void enterLook(PublishedModel& model, std::uint32_t tick);

 private:
  void share(Sequence& sequence);

  std::unordered_map<std::uint64_t, std::uint32_t> m_last_used;  ///< by sum: the tick of the last enterLook()
  std::unordered_map<std::uint64_t, Sequence> m_sequences;       ///< by sum: some of those that are published
};

}  // namespace naiad
