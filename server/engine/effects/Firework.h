// A particle of a firework; in a terminal it is like the others.
#pragma once

#include "Particle.h"

namespace df {

class Firework : public Particle {
 public:
  /// Like Particle's; the colour is r, g, b, 0 to 255 each.
  Firework(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b)
      : Particle(size, age, opacity, r, g, b) {}
};

}  // namespace df
