// The score: a point each second, and what saucers are worth.
#pragma once

#include "ViewObject.h"

#define POINTS_STRING "Points"

class Points : public df::ViewObject {
 public:
  Points();
  int eventHandler(const df::Event* p_e) override;
};
