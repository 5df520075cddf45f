// A particle that fades away.
#pragma once

#include "Particle.h"

namespace df {

class Fader : public Particle {
 public:
  /// Makes a Particle whose opacity falls by `opacity` / `age`, rounded down, in each tick.
  Fader(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b);
  Fader(float size, int age, unsigned char opacity, Color color);

  int eventHandler(const Event* p_e) override;

 private:
  unsigned char m_fade;  // opacity lost per tick
};

}  // namespace df
