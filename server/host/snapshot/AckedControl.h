// What a client takes for true of the object its player steers, going by the last record it was told.
#pragma once

#include "shared/replica/ControlCodec.h"

namespace naiad {

/// coast(), a tick at a time.
class AckedControl {
 public:
  /// The client was told this.
  void tell(const ControlRecord& record);
  /// Does it follow from what was told last, by the same table? Ticks must not go back.
  bool implies(const ControlRecord& truth, const df::ControlTable& table);

 private:
  bool m_told = false;
  bool m_at_rest = false;  ///< coasting on changes nothing any more
  int m_coasted = 0;       ///< ticks
  ControlRecord m_then;
};

}  // namespace naiad
