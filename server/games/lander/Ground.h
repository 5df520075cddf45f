// The moon's surface: a column of rock in each column of cells, with flat pads between the mountains.
#pragma once

#include "Object.h"

/// A column of rock: a HARD Object without mass, on which bodies rest and off which they bounce.
class Ground : public df::Object {
 public:
  /// Creates rock in column `x` from row `top` down. A landing on it earns `worth` points; 0: not a pad.
  Ground(int x, int top, int worth);
  int getWorth() const { return m_worth; }

  int draw() override;

 private:
  int m_worth;
};

/// Creates the whole landscape, which differs from world to world.
void makeLandscape();
