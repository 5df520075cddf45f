// The state of the steered object as a client computes it from the last record that it was sent.
#pragma once

#include "shared/replica/ControlCodec.h"

namespace naiad {

/// Computes coast() a tick at a time.
class AckedControl {
 public:
  /// `record` was sent.
  void setSent(const ControlRecord& record);
  /// Does `actual` follow from the last record by the same table? Ticks must not go back.
  bool implies(const ControlRecord& actual, const df::ControlTable& table);

 private:
  bool m_has_record = false;
  bool m_at_rest = false;  ///< coasting changes nothing any more
  int m_coasted = 0;       ///< ticks
  ControlRecord m_model;
};

}  // namespace naiad
