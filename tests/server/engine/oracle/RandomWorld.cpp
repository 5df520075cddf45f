#include "RandomWorld.h"

#include <algorithm>
#include <array>

namespace oracle {

Spec RandomWorld::randomSpec(Rng& rng) const {
  Spec spec;
  spec.position = randomPosition(rng);
  if (rng.chance(moving_percent)) spec.velocity = randomVelocity(rng);
  if (rng.chance(accelerated_percent)) spec.acceleration = randomAcceleration(rng);
  spec.box = randomBox(rng);
  spec.solidness = randomSolidness(rng);
  spec.no_soft = rng.chance(no_soft_percent);
  spec.active = !rng.chance(4);
  constexpr std::array<Temper, 11> tempers{Temper::QUIET,  Temper::QUIET,    Temper::QUIET,  Temper::QUIET,
                                           Temper::LIVELY, Temper::LIVELY,   Temper::LIVELY, Temper::BULLET,
                                           Temper::PARENT, Temper::STUBBORN, Temper::GLASS};
  spec.temper = tempers[static_cast<std::size_t>(rng.below(11))];
  if (rng.chance(deaf_percent)) spec.temper = Temper::DEAF;
  spec.options = options.randomOptions(rng);
  spec.mask = options.randomMask(rng);
  return spec;
}

FixedVector RandomWorld::randomPosition(Rng& rng) const {
  const FixedBox& area = areas[static_cast<std::size_t>(rng.below(static_cast<int>(areas.size())))];
  return {onGrain(area.corner.x + rng.between(0, area.size.x)),
          onGrain(area.corner.y + rng.between(0, area.size.y))};
}

FixedVector RandomWorld::randomVelocity(Rng& rng) const {
  const auto component = [&](Fixed limit) { return rng.between(-limit, limit); };
  const int what = rng.below(6);
  // If the limit is high, slow velocities are as frequent as fast ones.
  const Fixed fast =
      speed_limit > df::fromCells(20) ? std::max(speed_limit >> rng.below(22), kOne) : speed_limit;
  switch (what) {
    case 0:  // a cell per tick along an axis, as in most games
      return rng.chance(50) ? FixedVector{rng.chance(50) ? kOne : -kOne, 0}
                            : FixedVector{0, rng.chance(50) ? kOne : -kOne};
    case 1:  // a fraction of a cell
      return {onGrain(component(kOne)), onGrain(component(kOne))};
    case 2:  // at most two units, the slowest possible
      return {component(2), component(2)};
    case 3:  // fast, along an axis
      return rng.chance(50) ? FixedVector{component(fast), 0} : FixedVector{0, component(fast)};
    default: {
      const Fixed x = component(fast);
      return {x, component(fast)};
    }
  }
}

FixedVector RandomWorld::randomAcceleration(Rng& rng) const {
  if (rng.chance(30)) return {};
  const Fixed limit = kind == Kind::UNLIMITED ? 100 * kOne : kOne / 10;
  const Fixed x = rng.between(-limit, limit);
  return {x, rng.between(-limit, limit)};
}

FixedBox RandomWorld::randomBox(Rng& rng) const {
  const auto centred = [](Fixed width, Fixed height) {
    return FixedBox{{-width / 2, -height / 2}, {width, height}};
  };
  if (kind == Kind::HARD_CHARACTERS || kind == Kind::CHARACTERS) return centred(kOne, kOne);
  if (kind == Kind::HUGE_BOXES && rng.chance(20)) {
    const Fixed limit = df::fromCells(10'000) >> rng.below(12);
    const Fixed width = onGrain(rng.between(0, limit));
    return centred(width, onGrain(rng.between(0, limit)));
  }
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
    case 4:  // not centred: the box may even lie beside the position
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
  if (percent < mix_of_world[0] || kind == Kind::HARD_CHARACTERS) return df::HARD;
  if (percent < mix_of_world[1]) return df::SOFT;
  return df::SPECTRAL;
}

bool RandomWorld::isLost(FixedVector position) const {
  const Fixed far = df::fromCells(20);
  return std::none_of(areas.begin(), areas.end(), [&](const FixedBox& area) {
    return position.x >= area.corner.x - far && position.x <= area.corner.x + area.size.x + far &&
           position.y >= area.corner.y - far && position.y <= area.corner.y + area.size.y + far;
  });
}

}  // namespace oracle
