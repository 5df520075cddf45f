// The points of all pilots together in this round: one each second, plus those of the saucers.
#pragma once

#include "ViewObject.h"

inline constexpr const char* POINTS_STRING = "Points";

class Points : public df::ViewObject {
 public:
  Points();
  int eventHandler(const df::Event* p_e) override;

 private:
  bool m_counting = true;
};
