// Many particles at once: bursts, weather, explosions (Particle.h is one of them).
#pragma once

#include "Color.h"
#include "Particle.h"
#include "Precipitation.h"
#include "Vector.h"

namespace df {

class Sprite;

// Particles are only seen: they do not change the numbers of WM.randomInt().

/// Adds `count` particles, give or take count_spread, and so on for the others: around a position; in a
/// direction, (0,0) for any; size in pixels; speed in cells per tick; age in ticks; opacity 0 to 255; a
/// colour. At most 1000. Returns 0, or -1 for an unknown class.
int addParticles(int count, int count_spread, Vector position, float position_spread, Vector direction,
                 float direction_spread, float size, float size_spread, float speed, float speed_spread,
                 int age, int age_spread, unsigned char opacity, char opacity_spread, unsigned char r,
                 unsigned char g, unsigned char b, unsigned char color_spread,
                 ParticleClass particle_class = PARTICLE);
/// Adds smoke, sparks, rings or fireworks, in their own colours for CUSTOM. Returns 0, else -1.
int addParticles(ParticleType type, Vector position, float scale = 1.0, Color color = CUSTOM);
/// Adds snow, rain or stars all over the world, which never end. Returns 0, else -1.
int addParticles(PrecipitationType type, Direction direction, float scale = 1.0, Color color = CUSTOM);
/// Makes a frame's characters fly apart (together, if `speed` is negative) for `age` ticks. Returns 0, or -1
/// for null and for a number without a frame.
int explode(const Sprite* p_sprite, int index, Vector position, int age, float speed, float rotate);
/// Returns 0 at once. The published engine shows its name here before the game begins, but here no player has
/// joined at that time.
int splash();

}  // namespace df
