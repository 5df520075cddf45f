// A star in the background. When it leaves the view, it starts again at the right with another speed.
#pragma once

#include "Object.h"

class Star : public df::Object {
 public:
  Star();
  int draw() override;
  int eventHandler(const df::Event* p_e) override;

 private:
  void out();
};
