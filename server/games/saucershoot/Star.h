// A star in the background. Near stars are brighter and drift faster, which makes the sky look deep.
#pragma once

#include "Object.h"

class Star : public df::Object {
 public:
  /// Creates a star at a random position of the screen.
  Star();

  int eventHandler(const df::Event* p_e) override;
  int draw() override;

 private:
  bool m_near;
};
