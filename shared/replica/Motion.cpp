#include "shared/replica/Motion.h"

namespace naiad {

static df::Fixed extrapolate(df::Fixed p, df::Fixed w, df::Fixed a, std::int64_t n) {
  // n(n-1)/2 is whole and fits: |n| < 2^31. Unsigned, so that invalid numbers wrap with defined behaviour.
  const auto u = [](std::int64_t v) { return static_cast<std::uint64_t>(v); };
  return static_cast<df::Fixed>(u(p) + u(n) * u(w) + u(n * (n - 1) / 2) * u(a));
}

df::FixedVector positionAt(const Motion& m, std::uint32_t tick) {
  const std::int64_t n = static_cast<std::int32_t>(tick - m.tick);
  return {extrapolate(m.position.x, m.velocity.x, m.acceleration.x, n),
          extrapolate(m.position.y, m.velocity.y, m.acceleration.y, n)};
}

Motion rebase(const Motion& m, std::uint32_t tick) {
  const auto n = static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(tick - m.tick)});
  const auto velocity = [n](df::Fixed w, df::Fixed a) {
    return static_cast<df::Fixed>(static_cast<std::uint64_t>(w) + n * static_cast<std::uint64_t>(a));
  };
  return {tick,
          positionAt(m, tick),
          {velocity(m.velocity.x, m.acceleration.x), velocity(m.velocity.y, m.acceleration.y)},
          m.acceleration};
}

}  // namespace naiad
