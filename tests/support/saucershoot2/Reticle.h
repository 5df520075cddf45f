// A reticle at the position of the mouse.
#pragma once

#include "Object.h"

class Reticle : public df::Object {
 public:
  Reticle();
  int draw() override;
  int eventHandler(const df::Event* p_e) override;
};
