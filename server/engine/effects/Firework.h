// A particle of a firework; in a terminal it looks like any other particle.
#pragma once

#include "Particle.h"

namespace df {

class Firework : public Particle {
 public:
  /// See the constructor of Particle.
  Firework(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b)
      : Particle(size, age, opacity, r, g, b) {}
};

}  // namespace df
