// The functions of utility.h that make particles.

#include "engine/effects/Particles.h"

#include <algorithm>
#include <array>

#include "engine/effects/Debris.h"
#include "engine/effects/Fader.h"
#include "engine/effects/Precipitation.h"
#include "engine/managers/LogManager.h"
#include "engine/world/ColorMix.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "shared/math/Elementary.h"

namespace df {

namespace {

Random& dice() {
  return World::current().extras().decoration();
}

// Returns a random number between mean - spread and mean + spread.
double about(double mean, double spread) {
  constexpr int kSteps = 10'000;
  if (!(spread > 0)) return mean;
  return mean + spread * (2.0 * dice().below(kSteps + 1) / kSteps - 1);
}

unsigned char byte(double value) {
  return static_cast<unsigned char>(std::clamp(value, 0.0, 255.0));
}

Vector turned(double degrees) {
  const auto [sine, cosine] = math::sincos(degrees * (math::kPi / 180));
  return {cosine, sine};
}

Vector anyDirection() {
  return turned(dice().below(360));
}

// Halves the height, so that a round burst looks round: a cell is about twice as high as wide.
Vector asSeen(Vector v) {
  return {v.x(), v.y() / 2};
}

void spawn(Particle* p_particle, Vector position, Vector velocity) {
  p_particle->setPosition(position);
  p_particle->setVelocity(velocity);
}

struct Look {
  int count;
  float size;
  double speed;
  int age;
  std::array<unsigned char, 3> rgb;
};

Look lookOf(ParticleType type) {
  switch (type) {
    case SMOKE:
      return {10, 6, 0.05, 40, {160, 160, 160}};
    case SPARKS:
      return {12, 3, 0.5, 12, {255, 255, 0}};
    case RINGS:
      return {24, 5, 0.4, 20, {0, 255, 255}};
    default:
      return {30, 4, 0.5, 25, {255, 0, 255}};
  }
}

}  // namespace

int addParticles(int count, int count_spread, Vector position, float position_spread, Vector direction,
                 float direction_spread, float size, float size_spread, float speed, float speed_spread,
                 int age, int age_spread, unsigned char opacity, char opacity_spread, unsigned char r,
                 unsigned char g, unsigned char b, unsigned char color_spread, ParticleClass particle_class) {
  if (particle_class != PARTICLE && particle_class != FIREWORK) return -1;
  constexpr int kMax = 1000;
  const int n = std::min(kMax, static_cast<int>(about(count, count_spread)));
  for (int i = 0; i < n; ++i) {
    Vector velocity = direction == Vector()
                          ? anyDirection()
                          : direction + Vector(about(0, direction_spread), about(0, direction_spread));
    velocity.normalize();
    velocity.scale(about(speed, speed_spread));
    const auto part = [&](unsigned char c) { return byte(about(c, color_spread)); };
    auto* p_particle = new Particle(static_cast<float>(about(size, size_spread)),
                                    std::max(1, static_cast<int>(about(age, age_spread))),
                                    byte(about(opacity, opacity_spread)), part(r), part(g), part(b));
    spawn(p_particle, position + Vector(about(0, position_spread), about(0, position_spread)), velocity);
  }
  return 0;
}

int addParticles(ParticleType type, Vector position, float scale, Color color) {
  if (type < SMOKE || type > FIREWORKS) return -1;
  Look look = lookOf(type);
  if (color >= BLACK && color <= WHITE) colorToRGB(color, look.rgb[0], look.rgb[1], look.rgb[2]);
  const double size = std::clamp(static_cast<double>(scale), 0.1, 10.0);
  const int n = std::max(1, static_cast<int>(look.count * size));
  for (int i = 0; i < n; ++i) {
    Vector velocity = type == RINGS ? turned(360.0 * i / n) : anyDirection();
    velocity.scale(type == RINGS ? look.speed * size : about(look.speed, look.speed / 2) * size);
    if (type == SMOKE) velocity = velocity + Vector(0, -look.speed);
    auto* p_particle = new Fader(look.size, static_cast<int>(about(look.age, look.age / 4.0)), 255,
                                 look.rgb[0], look.rgb[1], look.rgb[2]);
    spawn(p_particle, position, asSeen(velocity));
  }
  return 0;
}

int addParticles(PrecipitationType type, Direction direction, float scale, Color color) {
  if (type < SNOW || type > STARFIELD || direction < UP || direction > RIGHT) return -1;
  std::array<unsigned char, 3> rgb{255, 255, 255};
  if (type == RAIN) rgb = {0, 0, 255};
  if (color >= BLACK && color <= WHITE) colorToRGB(color, rgb[0], rgb[1], rgb[2]);
  const int n = static_cast<int>(30 * std::clamp(static_cast<double>(scale), 0.1, 10.0));
  const bool vertical = direction == UP || direction == DOWN;
  for (int i = 0; i < n; ++i) {
    auto* p_drop = new Precipitation(type == SNOW ? 5.0f : 2.0f, direction, 255, rgb[0], rgb[1], rgb[2]);
    const double speed = type == RAIN ? 0.8 : type == SNOW ? 0.15 : about(0.6, 0.4);
    p_drop->fall(vertical ? speed : 2 * speed);
    p_drop->setTurbulence(type == SNOW);
  }
  return 0;
}

int explode(const Sprite* p_sprite, int index, Vector position, int age, float speed, float rotate) {
  if (p_sprite == nullptr || index < 0 || index >= p_sprite->getFrameCount()) return -1;
  const Frame frame = p_sprite->getFrame(index);
  const Vector middle((frame.getWidth() - 1) / 2.0, (frame.getHeight() - 1) / 2.0);
  for (int y = 0; y < frame.getHeight(); ++y) {
    for (int x = 0; x < frame.getWidth(); ++x) {
      const char ch = frame.at(x, y);
      if (ch == ' ' || (p_sprite->getTransparency() != 0 && ch == p_sprite->getTransparency())) continue;
      const Vector offset = Vector(x, y) - middle;
      Vector velocity = offset == Vector() ? anyDirection() : offset;
      velocity.normalize();
      velocity.scale(speed);
      // Characters that fly together (speed < 0) start where they would have flown apart to.
      Vector start = position + offset;
      if (speed < 0) start = start - Vector(velocity.x() * age, velocity.y() * age);
      auto* p_debris = new Debris(age, 255, p_sprite->getColor(), velocity, ch, rotate);
      p_debris->setPosition(start);
    }
  }
  return 0;
}

int splash() {
  return 0;
}

}  // namespace df
