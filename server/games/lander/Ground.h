// The moon: a column of rock for each column of cells, with flat pads between the mountains.
#pragma once

#include "Object.h"

/// A HARD Object without mass: bodies rest on it and bounce off it.
class Ground : public df::Object {
 public:
  /// Rock in column `x` from row `top` down; `worth` points for a landing, 0: no pad.
  Ground(int x, int top, int worth);
  int getWorth() const { return m_worth; }

  int draw() override;

 private:
  int m_worth;
};

/// The whole landscape, another one in each world.
void makeLandscape();
