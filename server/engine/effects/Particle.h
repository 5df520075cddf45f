// A spark, a drop, a puff: a short-lived Object that is only for the eye. In a terminal a particle is one
// character (Shape.h), so a few dozen are enough (addParticles() in utility.h).
#pragma once

#include "Object.h"

namespace df {

/// Value of a spread argument of addParticles() with which all particles are equal.
inline constexpr int NO_SPREAD = 0;

/// Kinds of particles that addParticles() makes.
enum ParticleType {
  UNDEFINED_PARTICLE_TYPE = -1,
  SMOKE,
  SPARKS,
  RINGS,
  FIREWORKS,
};

/// Classes of particles that addParticles() makes.
enum ParticleClass {
  UNDEFINED_PARTICLE_CLASS = -1,
  PARTICLE,
  FIREWORK,
};

/// Directions in which particles of addParticles() move.
enum Direction {
  UNDEFINED_DIRECTION = -1,
  UP,
  DOWN,
  LEFT,
  RIGHT,
};

class Particle : public Object {
 public:
  /// Makes a SPECTRAL Object of type "df-particle" at MAX_ALTITUDE, with this size in pixels, age in ticks,
  /// opacity (0 to 255) and colour.
  Particle(float size, int age, unsigned char opacity, unsigned char r, unsigned char g, unsigned char b);
  Particle(float size, int age, unsigned char opacity, Color color);

  /// The colour; red, green and blue 0 to 255.
  void setRGB(Color color);
  void setRGB(unsigned char r, unsigned char g, unsigned char b);
  /// Number of ticks until the particle is deleted.
  void setAge(int new_age) { m_age = new_age; }
  int getAge() const { return m_age; }

  /// Lowers the age by one in each step. Deletes the particle at age 0, and when it leaves the world.
  int eventHandler(const Event* p_e) override;

 private:
  void initialise(float size, unsigned char opacity);

  int m_age;
};

}  // namespace df
