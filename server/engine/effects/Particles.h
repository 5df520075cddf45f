// Many particles at once: bursts, weather, explosions (Particle.h is one of them).
#pragma once

#include "Color.h"
#include "Particle.h"
#include "Precipitation.h"
#include "Vector.h"

namespace df {

class Sprite;

// What is only seen. None of it changes the numbers of WM.randomInt().

/// Add about `count` particles, give or take count_spread, as for the others: around a position; in a
/// direction, (0,0) for any; size in pixels; speed in cells per tick; age in ticks; opacity 0 to 255; a
/// colour. At most 1000. Return 0, or -1 for a class that there is none of.
int addParticles(int count, int count_spread, Vector position, float position_spread, Vector direction,
                 float direction_spread, float size, float size_spread, float speed, float speed_spread,
                 int age, int age_spread, unsigned char opacity, char opacity_spread, unsigned char r,
                 unsigned char g, unsigned char b, unsigned char color_spread,
                 ParticleClass particle_class = PARTICLE);
/// Smoke, sparks, rings or fireworks, in their own colours for CUSTOM. Return 0, else -1.
int addParticles(ParticleType type, Vector position, float scale = 1.0, Color color = CUSTOM);
/// Snow, rain or stars all over the world, for ever. Return 0, else -1.
int addParticles(PrecipitationType type, Direction direction, float scale = 1.0, Color color = CUSTOM);
/// A frame's characters fly apart (together, if `speed` is negative), for `age` ticks. Return 0, or -1 for
/// null and for a number without a frame.
int explode(const Sprite* p_sprite, int index, Vector position, int age, float speed, float rotate);
/// The published engine shows its name here before the game begins. Here no player has joined by then, so it
/// returns at once. Return 0.
int splash();

}  // namespace df
