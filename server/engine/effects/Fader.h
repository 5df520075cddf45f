// A particle that fades away.
#pragma once

#include "Particle.h"

namespace df {

class Fader : public Particle {
 public:
  /// Makes a Particle whose opacity falls by `opacity` / `age` in each tick, rounded down unless that is 0.
  Fader(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b);
  Fader(float size, int age, unsigned char opacity, Color color);

  int eventHandler(const Event* p_e) override;

 private:
  float m_fade;      // opacity lost per tick
  float m_lost = 0;  // below 1: lost opacity that the shape still has
};

}  // namespace df
