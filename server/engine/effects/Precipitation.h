// Rain, snow and stars: particles that leave the world and enter it again on the other side.
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
  /// Makes a particle at a random place in the world, at the lowest altitude.
  Precipitation(float size, Direction direction, unsigned char opacity, unsigned char r, unsigned char g,
                unsigned char b);

  /// Makes the particle move in its direction. `speed` is in cells per tick.
  void fall(double speed);
  /// Whether the particle sways to the sides at random.
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
