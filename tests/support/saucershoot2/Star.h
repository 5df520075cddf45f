// A star in the background; when it has passed by it is another one.
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
