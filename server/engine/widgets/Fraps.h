// Shows the number of frames that the game makes in a second, at the top right in green, as "fps". F9 hides
// and shows the number.
//
// The second is one of game time, so the number follows from the setting `frame_time`, even if a server is
// slower. Nothing is recorded.
#pragma once

#include <string>

#include "ViewObject.h"

namespace df {

/// Text before the number.
const std::string FRAPS_STRING = "fps";

class Fraps : public ViewObject {
 public:
  /// Makes the ViewObject, green and at the top right. `do_record` has no effect.
  explicit Fraps(bool do_record = false);

  int eventHandler(const Event* p_e) override;

  /// Has no effect.
  void setRecord(bool /*new_record*/) {}
  void setLogFrameRate(bool /*new_do_frame_rate*/) {}
};

}  // namespace df
