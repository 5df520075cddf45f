// Rain, snow and stars that pass by: particles that leave the world and enter it again on the other side.
#pragma once

#include "Particle.h"

namespace df {

/// Kinds of weather.
enum PrecipitationType {
  UNDEFINED_PRECIPITATION_TYPE = -1,
  SNOW,
  RAIN,
  STARFIELD,
};

class Precipitation : public Particle {
 public:
  /// Makes one at a random place in the world, below everything else.
  Precipitation(float size, Direction direction, unsigned char opacity, unsigned char r, unsigned char g,
                unsigned char b);

  /// Moves in its direction, in cells per tick.
  void fall(double speed);
  /// Whether it wavers to the sides.
  void setTurbulence(bool new_turbulence = true) { m_turbulence = new_turbulence; }
  int eventHandler(const Event* p_e) override;

 private:
  void enter(bool anywhere);
  bool isVertical() const { return m_direction == UP || m_direction == DOWN; }

  Direction m_direction;
  Vector m_velocity;
  bool m_turbulence = false;
};

}  // namespace df
