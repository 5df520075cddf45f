// Many particles at once: bursts, weather, explosions. Particle.h has the single particle.
#pragma once

#include "Color.h"
#include "Particle.h"
#include "Precipitation.h"
#include "Vector.h"

namespace df {

class Sprite;

// Particles have random numbers of their own, so that they do not change those of WM.randomInt().

/// Adds `count` particles around a position, at most 1000. Each argument with a spread is a mean, from which
/// the values differ by up to the spread. A direction (0,0) means all directions. Size is in pixels, speed in
/// cells per tick, age in ticks, opacity 0 to 255. Returns 0, or -1 for an unknown class.
int addParticles(int count, int count_spread, Vector position, float position_spread, Vector direction,
                 float direction_spread, float size, float size_spread, float speed, float speed_spread,
                 int age, int age_spread, unsigned char opacity, char opacity_spread, unsigned char r,
                 unsigned char g, unsigned char b, unsigned char color_spread,
                 ParticleClass particle_class = PARTICLE);
/// Adds smoke, sparks, rings or fireworks; CUSTOM means their own colours. Returns 0, or -1 for other types.
int addParticles(ParticleType type, Vector position, float scale = 1.0, Color color = CUSTOM);
/// Adds snow, rain or stars everywhere; they do not age. Returns 0, or -1 for other types or directions.
int addParticles(PrecipitationType type, Direction direction, float scale = 1.0, Color color = CUSTOM);
/// Makes the characters of frame `index` fly apart (together, if `speed` is negative) for `age` ticks.
/// Returns 0, or -1 if `p_sprite` is null or has no such frame.
int explode(const Sprite* p_sprite, int index, Vector position, int age, float speed, float rotate);
/// Does nothing and returns 0. The published engine shows its name in this function before the game begins,
/// but in Naiad no player has joined at that time.
int splash();

}  // namespace df
