// A wall, a floor, a rail: HARD, without mass, and nothing moves it. Bodies lie on it and bounce off it
// (PM.setObstacleFriction, setObstacleRestitution).
#pragma once

#include "Color.h"
#include "Object.h"
#include "Vector.h"

namespace df {

class Obstacle : public Object {
 public:
  /// Of `width` by `height` whole cells, `corner` the one on the upper left, all drawn as `ch`. For numbers
  /// out of range it keeps the position or the box of a new Object.
  Obstacle(Vector corner, int width, int height, char ch = '#', Color color = COLOR_DEFAULT);

  int draw() override;

 private:
  char m_ch;
  Color m_color;
};

}  // namespace df
