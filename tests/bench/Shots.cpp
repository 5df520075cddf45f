#include "Shots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace bench {

namespace {

using naiad::SplitMix64;

constexpr double kTicksPerSecond = 30;
constexpr double kFastPart = 0.1;  // of the shots that are faster than a million cells per second
constexpr double kFieldSide = 1000;

df::Fixed fixed(double cells) {
  return std::llrint(cells * static_cast<double>(df::kFixedOne));
}

double between(double least, double most, SplitMix64& random) {
  return least + (most - least) * random.unit();
}

double logarithmicallyBetween(double least, double most, SplitMix64& random) {
  return std::exp(between(std::log(least), std::log(most), random));
}

df::FixedBox boxOf(double width, double height) {
  return {{-fixed(width) / 2, -fixed(height) / 2}, {fixed(width), fixed(height)}};
}

Flier shape(Shape shape, SplitMix64& random) {
  Flier flier;
  double width = 1;
  double height = 1;
  if (shape == Shape::SPRITE || shape == Shape::GLYPHS) {
    const Glyphs glyphs = Glyphs::random(random);
    width = glyphs.width();
    height = glyphs.height();
    if (shape == Shape::GLYPHS) flier.glyphs = glyphs;
  }
  if (shape == Shape::THIN || shape == Shape::NEEDLE) width = 0.01;
  if (shape == Shape::NEEDLE) height = 0.01;
  if (shape == Shape::THIN) height = 8;
  if (shape == Shape::WALL) width = 10'000;
  if (shape != Shape::GLYPHS && random.below(2) == 0) std::swap(width, height);
  flier.box = boxOf(width, height);
  return flier;
}

// How far a shot goes in a tick. Positions are read as doubles, so it must not go on for ticks at the highest
// speeds.
double drawSpeed(const Pairing& pairing, SplitMix64& random) {
  if (pairing.speed > 0) return pairing.speed;
  const double usual = 1e6 / kTicksPerSecond;
  if (pairing.ticks == 1 && random.unit() < kFastPart) return logarithmicallyBetween(usual, 1e6, random);
  return logarithmicallyBetween(0.1 / kTicksPerSecond, usual, random);
}

df::FixedVector drawVelocity(const Pairing& pairing, SplitMix64& random) {
  const double speed = drawSpeed(pairing, random);
  const double angle = 2 * std::numbers::pi * random.unit();
  return {fixed(speed * std::cos(angle)), fixed(speed * std::sin(angle))};
}

void chooseVelocities(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  if (pairing.motion != Motion::REST) older.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::FIRES) younger.velocity = drawVelocity(pairing, random);
  if (pairing.motion != Motion::HEAD_ON) return;
  const df::Fixed ahead = fixed(drawSpeed(pairing, random));
  const df::Fixed against = fixed(drawSpeed(pairing, random));
  const df::Fixed aside = fixed(between(-0.3, 0.3, random));
  older.velocity = {ahead, aside};
  younger.velocity = {-against, fixed(between(-0.3, 0.3, random))};
  if (random.below(2) == 0) return;
  for (Flier* p_flier : {&older, &younger}) std::swap(p_flier->velocity.x, p_flier->velocity.y);
}

// A place of the younger one relative to the older one at which they touch: mostly just so.
df::FixedVector drawContact(const Flier& older, const Flier& younger, SplitMix64& random) {
  const double reach_x = df::toCells(older.box.size.x + younger.box.size.x) / 2;
  const double reach_y = df::toCells(older.box.size.y + younger.box.size.y) / 2;
  double x = between(-1, 1, random);
  double y = between(-1, 1, random);
  (random.below(2) == 0 ? x : y) = random.below(2) == 0 ? 1 : -1;
  const double depth = random.unit() < 0.6 ? 1 : between(0, 1.1, random);
  return {fixed(depth * x * reach_x), fixed(depth * y * reach_y)};
}

df::FixedVector times(df::FixedVector v, double factor) {
  return {fixed(df::toCells(v.x) * factor), fixed(df::toCells(v.y) * factor)};
}

}  // namespace

void aim(const Pairing& pairing, Flier& older, Flier& younger, SplitMix64& random) {
  do {
    older = shape(pairing.older, random);
    younger = shape(pairing.younger, random);
    chooseVelocities(pairing, older, younger, random);
    const double x = between(-kFieldSide, kFieldSide, random);
    const double y = between(-kFieldSide, kFieldSide, random);
    older.position = {fixed(x), fixed(y)};
    const double time = random.unit() * std::max(1, pairing.ticks - 2);
    double older_gone = time;
    double younger_gone = time;
    if (pairing.motion == Motion::BOTH || pairing.motion == Motion::HEAD_ON) {
      const std::uint64_t moment = random.below(3);
      if (moment == 0) younger_gone = 0;
      if (moment == 1) older_gone = 1;
    }
    younger.position = older.position + times(older.velocity, older_gone) -
                       times(younger.velocity, younger_gone) + drawContact(older, younger, random);
  } while (areMet(older, younger));
}

}  // namespace bench
