// Lays out a random world: its kind, size, boundary, and the shares of its properties.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "RandomWorld.h"

namespace oracle {

namespace {

Kind randomKind(Rng& rng) {
  const int which = rng.below(1000);
  if (which < 2) return Kind::LARGE;
  if (which < 50) return Kind::HARD_CHARACTERS;
  if (which < 100) return Kind::CHARACTERS;
  if (which < 130) return Kind::NEARLY_CHARACTERS;
  if (which < 180) return Kind::UNLIMITED;
  if (which < 210) return Kind::HUGE_BOXES;
  if (which < 250) return Kind::FAR;
  if (which < 280) return Kind::SCATTERED;
  if (which < 300) return Kind::CROWDED;
  return Kind::USUAL;
}

// Most worlds are small so that many can run; a few are as large as a busy game.
int randomPopulation(Rng& rng, Kind kind) {
  const int size = rng.below(100);
  if (kind == Kind::LARGE) return 1000;
  if (kind == Kind::CROWDED) return static_cast<int>(rng.between(2, 24));
  if (size < 65) return static_cast<int>(rng.between(2, 20));
  if (size < 91 || kind == Kind::HUGE_BOXES) return static_cast<int>(rng.between(20, 60));
  if (size < 99) return static_cast<int>(rng.between(60, 150));
  return static_cast<int>(rng.between(150, 300));
}

FixedBox cellBox(std::int32_t x, std::int32_t y, std::int32_t width, std::int32_t height) {
  return {{df::fromCells(x), df::fromCells(y)}, {df::fromCells(width), df::fromCells(height)}};
}

}  // namespace

RandomWorld::RandomWorld(std::uint64_t world_seed, bool with_options) : seed(world_seed) {
  Rng rng(mix(world_seed));
  kind = randomKind(rng);
  const int population = randomPopulation(rng, kind);
  population_limit = std::min(std::max(300, population + 100), population * 2 + 10);
  layOut(rng, population);

  constexpr std::array<int, 4> speeds{1, 2, 6, 20};
  speed_limit = df::fromCells(speeds[static_cast<std::size_t>(rng.below(4))]);
  constexpr std::array<int, 4> movings{10, 50, 80, 100};
  moving_percent = movings[static_cast<std::size_t>(rng.below(4))];
  solid_mix = rng.below(5);
  no_soft_percent = rng.chance(50) ? 10 : 40;
  large_percent = population > 60 ? 5 : 20;
  accelerated_percent = rng.chance(50) ? 5 : 40;
  constexpr std::array<int, 5> deafs{0, 0, 0, 10, 60};
  deaf_percent = deafs[static_cast<std::size_t>(rng.below(5))];
  if (rng.chance(3)) moves_per_tick = 120;  // enough to reach the deepest nesting more than once
  specialise(rng);

  Rng own(rng.next());
  options = OptionMix::random(own);
  if (options.precise > 0 && large_percent == 20) large_percent = 50;  // because a character has no holes
  if (!with_options) options = {};

  for (int i = 0; i < population; ++i) objects.push_back(randomSpec(rng));
}

void RandomWorld::layOut(Rng& rng, int population) {
  constexpr std::array<Fixed, 5> grains{kOne, kOne / 2, kOne / 4, kOne / 10, 1};
  grain = grains[static_cast<std::size_t>(rng.below(5))];

  // Cells per Object. Large worlds are never packed because pairs grow with the square of the crowd.
  constexpr std::array<int, 4> rooms{2, 5, 12, 40};
  const int room = rooms[static_cast<std::size_t>(population > 60 ? 2 + rng.below(2) : rng.below(4))];
  const auto width = static_cast<std::int32_t>(2 + std::sqrt(population * room * 2.0));
  const auto height = static_cast<std::int32_t>(2 + population * room / width);

  // Three worlds in ten lie a million cells from the origin, in a huge boundary or with a boundary of their
  // own. One in ten (-7) lies across the origin.
  constexpr std::array<std::int32_t, 10> places{0, 0, 0, 0, 0, 0, 999'000, 999'000, -999'000, -7};
  const std::int32_t away = places[static_cast<std::size_t>(rng.below(10))];
  boundary = cellBox(0, 0, std::abs(away) + width, std::abs(away) + height);
  if (away < 0 || rng.chance(50)) boundary = cellBox(away, away, width, height);
  const std::int32_t margin = rng.below(4);
  const auto area = [&](std::int32_t x, std::int32_t y) {
    return cellBox(x - margin, y - margin, width + 2 * margin, height + 2 * margin);
  };
  areas = {area(away, away)};

  // The engine accepts positions up to 2e9 cells; a boundary is never that far away.
  constexpr std::int32_t kFar = 1'999'000'000;
  if (kind == Kind::FAR) {
    const std::int32_t x = rng.chance(50) ? kFar : -kFar;
    const std::int32_t y = rng.chance(50) ? kFar : -kFar;
    areas = {area(x, y)};
    if (rng.chance(50)) areas.push_back(area(-x, rng.chance(50) ? y : -y));
  }
}

void RandomWorld::specialise(Rng& rng) {
  switch (kind) {
    case Kind::USUAL:
    case Kind::HARD_CHARACTERS:
    case Kind::CHARACTERS:
      break;
    case Kind::NEARLY_CHARACTERS:
      large_percent = 1;
      break;
    case Kind::UNLIMITED:
      speed_limit = df::fromCells(1'000'000);
      break;
    case Kind::HUGE_BOXES:
      boundary = cellBox(0, 0, 200, 150);
      areas = {boundary};
      if (rng.chance(50)) speed_limit = df::fromCells(1'000);
      break;
    case Kind::FAR:
      if (rng.chance(50)) speed_limit = df::fromCells(100'000);
      break;
    case Kind::SCATTERED:
      boundary = cellBox(0, 0, 1'000'000, 1'000'000);
      areas = {boundary, boundary, boundary};
      for (int town = 0; town < 5; ++town) {
        const int x = rng.below(999'000);
        areas.push_back(cellBox(x, rng.below(999'000), 8, 5));
      }
      if (rng.chance(50)) speed_limit = df::fromCells(1'000'000);
      break;
    case Kind::CROWDED: {
      Rng own(rng.next());
      areas = {{randomPosition(own), {}}};
      break;
    }
    case Kind::LARGE:
      moving_percent = 15;
      speed_limit = df::fromCells(2);
      break;
  }
}

}  // namespace oracle
