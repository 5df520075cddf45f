// What all pilots have earned together in this round: a point each second, and what saucers are worth.
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
