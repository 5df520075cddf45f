// A character of a sprite that has exploded (explode() in utility.h).
#pragma once

#include "Particle.h"

namespace df {

class Debris : public Particle {
 public:
  /// `rotate`, in degrees per tick, has no effect, because terminals do not turn characters.
  Debris(int age, unsigned char opacity, Color color, Vector velocity, char ch, float rotate);

  DF_DRAW draw() override;

 private:
  char m_ch;
  Color m_color;
};

}  // namespace df
