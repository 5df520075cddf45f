// A star behind everything. The near ones are brighter and drift faster, which makes the sky look deep.
#pragma once

#include "Object.h"

class Star : public df::Object {
 public:
  /// Somewhere on the screen.
  Star();

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  bool m_near;
};
