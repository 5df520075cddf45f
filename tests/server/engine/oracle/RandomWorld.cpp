#include "RandomWorld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace oracle {

static constexpr Fixed kOne = df::kFixedOne;

// Most worlds are small, so that there can be many; a few are as large as a busy game.
static int randomPopulation(Rng& rng) {
  const int size = rng.below(100);
  if (size < 60) return static_cast<int>(rng.between(2, 20));
  if (size < 87) return static_cast<int>(rng.between(20, 60));
  if (size < 98) return static_cast<int>(rng.between(60, 150));
  return static_cast<int>(rng.between(150, 300));
}

RandomWorld::RandomWorld(std::uint64_t world_seed) : seed(world_seed) {
  Rng rng(mix(world_seed));
  const int population = randomPopulation(rng);
  population_limit = std::min(300, population * 2 + 10);

  constexpr std::array<Fixed, 5> grains{kOne, kOne / 2, kOne / 4, kOne / 10, 1};
  grain = grains[static_cast<std::size_t>(rng.below(5))];

  // Cells per Object. Large worlds are never packed: their pairs grow with the square of the crowd.
  constexpr std::array<int, 4> rooms{2, 5, 12, 40};
  const int room = rooms[static_cast<std::size_t>(population > 60 ? 2 + rng.below(2) : rng.below(4))];
  const auto width = static_cast<std::int32_t>(2 + std::sqrt(population * room * 2.0));
  const auto height = static_cast<std::int32_t>(2 + population * room / width);

  // One world in five lies a million cells away from the origin: at the far corner of a huge boundary, or
  // with a boundary that is away, too. One lies across it.
  constexpr std::array<std::int32_t, 10> places{0, 0, 0, 0, 0, 0, 999'000, 999'000, -999'000, -7};
  const std::int32_t away = places[static_cast<std::size_t>(rng.below(10))];
  boundary = {{}, {df::fromCells(std::abs(away) + width), df::fromCells(std::abs(away) + height)}};
  if (away < 0 || rng.chance(50)) {
    boundary = {{df::fromCells(away), df::fromCells(away)}, {df::fromCells(width), df::fromCells(height)}};
  }
  const Fixed margin = df::fromCells(rng.below(4));
  area = {{df::fromCells(away) - margin, df::fromCells(away) - margin},
          {df::fromCells(width) + 2 * margin, df::fromCells(height) + 2 * margin}};

  constexpr std::array<int, 4> speeds{1, 2, 6, 20};
  speed_limit = df::fromCells(speeds[static_cast<std::size_t>(rng.below(4))]);
  constexpr std::array<int, 4> movings{10, 50, 80, 100};
  moving_percent = movings[static_cast<std::size_t>(rng.below(4))];
  solid_mix = rng.below(5);
  no_soft_percent = rng.chance(50) ? 10 : 40;
  large_percent = population > 60 ? 5 : 20;
  accelerated_percent = rng.chance(50) ? 5 : 40;
  if (rng.chance(3)) moves_per_tick = 120;  // room for the deepest nesting, more than once

  for (int i = 0; i < population; ++i) objects.push_back(randomSpec(rng));
}

Spec RandomWorld::randomSpec(Rng& rng) const {
  Spec spec;
  spec.position = randomPosition(rng);
  if (rng.chance(moving_percent)) spec.velocity = randomVelocity(rng);
  if (rng.chance(accelerated_percent)) spec.acceleration = randomAcceleration(rng);
  spec.box = randomBox(rng);
  spec.solidness = randomSolidness(rng);
  spec.no_soft = rng.chance(no_soft_percent);
  spec.active = !rng.chance(4);
  constexpr std::array<Temper, 10> tempers{Temper::QUIET,  Temper::QUIET,   Temper::QUIET,  Temper::QUIET,
                                           Temper::LIVELY, Temper::LIVELY,  Temper::LIVELY, Temper::BULLET,
                                           Temper::PARENT, Temper::STUBBORN};
  spec.temper = tempers[static_cast<std::size_t>(rng.below(10))];
  return spec;
}

FixedVector RandomWorld::randomPosition(Rng& rng) const {
  return {onGrain(area.corner.x + rng.between(0, area.size.x)),
          onGrain(area.corner.y + rng.between(0, area.size.y))};
}

FixedVector RandomWorld::randomVelocity(Rng& rng) const {
  const auto component = [&](Fixed limit) { return rng.between(-limit, limit); };
  switch (rng.below(6)) {
    case 0:  // a cell per tick along an axis, as most games have it
      return rng.chance(50) ? FixedVector{rng.chance(50) ? kOne : -kOne, 0}
                            : FixedVector{0, rng.chance(50) ? kOne : -kOne};
    case 1:  // a fraction of a cell
      return {onGrain(component(kOne)), onGrain(component(kOne))};
    case 2:  // the least there is
      return {component(2), component(2)};
    case 3:  // fast, along an axis
      return rng.chance(50) ? FixedVector{component(speed_limit), 0} : FixedVector{0, component(speed_limit)};
    default:
      return {component(speed_limit), component(speed_limit)};
  }
}

FixedVector RandomWorld::randomAcceleration(Rng& rng) const {
  if (rng.chance(30)) return {};
  return {rng.between(-kOne / 10, kOne / 10), rng.between(-kOne / 10, kOne / 10)};
}

FixedBox RandomWorld::randomBox(Rng& rng) const {
  const auto centred = [](Fixed width, Fixed height) {
    return FixedBox{{-width / 2, -height / 2}, {width, height}};
  };
  if (!rng.chance(large_percent)) return centred(kOne, kOne);
  switch (rng.below(7)) {
    case 0:
      return centred(12 * kOne, 4 * kOne);
    case 1:
      return centred(0, 0);
    case 2:
      return rng.chance(50) ? centred(0, 3 * kOne) : centred(5 * kOne, 0);
    case 3:
      return centred(3 * kOne, 2 * kOne);
    case 4:  // not centred: it may even lie beside the position
      return {{onGrain(rng.between(-4 * kOne, 4 * kOne)), onGrain(rng.between(-4 * kOne, 4 * kOne))},
              {rng.between(0, 6 * kOne), rng.between(0, 3 * kOne)}};
    case 5:  // larger than most worlds
      if (rng.chance(20)) return centred(120 * kOne, 33 * kOne);
      return centred(7 * kOne, kOne);
    default: {
      const Fixed width = rng.between(0, 3 * kOne);
      return centred(width, rng.between(0, 3 * kOne));
    }
  }
}

Solidness RandomWorld::randomSolidness(Rng& rng) const {
  constexpr std::array<std::array<int, 2>, 5> mixes{{{34, 67}, {90, 95}, {5, 90}, {10, 20}, {50, 100}}};
  const auto& mix_of_world = mixes[static_cast<std::size_t>(solid_mix)];
  const int percent = rng.below(100);
  if (percent < mix_of_world[0]) return df::HARD;
  if (percent < mix_of_world[1]) return df::SOFT;
  return df::SPECTRAL;
}

}  // namespace oracle
