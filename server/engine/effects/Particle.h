// A spark, a drop, a puff: a short-lived Object that is only seen. In a terminal a particle is one character
// (Shape.h), so hundreds of them are a crowd: addParticles() in utility.h makes a few.
#pragma once

#include "Object.h"

namespace df {

/// For addParticles(): none of it differs from one particle to the next.
inline constexpr int NO_SPREAD = 0;

/// What addParticles() makes many of.
enum ParticleType {
  UNDEFINED_PARTICLE_TYPE = -1,
  SMOKE,
  SPARKS,
  RINGS,
  FIREWORKS,
};

/// Which class of particles addParticles() makes.
enum ParticleClass {
  UNDEFINED_PARTICLE_CLASS = -1,
  PARTICLE,
  FIREWORK,
};

/// Of addParticles(): towards where they move.
enum Direction {
  UNDEFINED_DIRECTION = -1,
  UP,
  DOWN,
  LEFT,
  RIGHT,
};

class Particle : public Object {
 public:
  /// SPECTRAL, of type "df-particle", at MAX_ALTITUDE; of this size in pixels, for so many ticks, with this
  /// opacity (0 to 255) and colour.
  Particle(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b);
  Particle(float size, int age, unsigned char opacity, Color color);

  /// The colour; red, green and blue 0 to 255.
  void setRGB(Color color);
  void setRGB(unsigned char r, unsigned char g, unsigned char b);
  /// Ticks that are left.
  void setAge(int new_age) { m_age = new_age; }
  int getAge() const { return m_age; }

  /// Each step makes it older; at 0, and outside the world, it ends.
  int eventHandler(const Event* p_e) override;

 private:
  void initialise(float size, unsigned char opacity);

  int m_age;
};

}  // namespace df
