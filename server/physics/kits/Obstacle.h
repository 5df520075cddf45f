// A wall, floor or rail: HARD, without mass, unmovable. Bodies rest on it and bounce off it
// (PM.setObstacleFriction, setObstacleRestitution).
#pragma once

#include "Color.h"
#include "Object.h"
#include "Vector.h"

namespace df {

class Obstacle : public Object {
 public:
  /// Creates a block of `width` by `height` whole cells, drawn as `ch`; `corner` is its upper left cell. If a
  /// number is out of range, the position or box of a new Object is kept.
  Obstacle(Vector corner, int width, int height, char ch = '#', Color color = COLOR_DEFAULT);

  int draw() override;

 private:
  char m_ch;
  Color m_color;
};

}  // namespace df
