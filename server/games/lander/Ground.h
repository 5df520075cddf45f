// The moon's surface: a column of rock per column of cells, with flat pads between the mountains.
#pragma once

#include "Object.h"

/// A HARD Object without mass: bodies rest on it and bounce off it.
class Ground : public df::Object {
 public:
  /// Creates rock in column `x` from row `top` down. A landing earns `worth` points; 0: not a pad.
  Ground(int x, int top, int worth);
  int getWorth() const { return m_worth; }

  int draw() override;

 private:
  int m_worth;
};

/// Creates the whole landscape, a different one in each world.
void makeLandscape();
