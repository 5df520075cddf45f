// The score: one point each second, and ten for each saucer.
#pragma once

#include "ViewObject.h"

#define POINTS_STRING "Points"

class Points : public df::ViewObject {
 public:
  Points();
  int eventHandler(const df::Event* p_e) override;
};
