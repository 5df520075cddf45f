#include "physics/substep/ContactRows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/geometry/Index.h"
#include "physics/geometry/Reserve.h"
#include "physics/substep/Softness.h"

namespace naiad::physics {

namespace {

// Damping ratio of the spring that undoes overlap. With an immovable body, it oscillates twice as fast.
constexpr float kContactDamping = 10;
// Oscillations per sub-step and damping ratio of lasting contacts. A sweep moves an impulse only to the next
// body. From 0.22 oscillations on, this delay cancels the damping, and a pile would oscillate without end.
constexpr float kLastingTurns = 0.19f;
constexpr float kLastingDamping = 4;
// Fractions of the trend of a lasting contact's impulse:
constexpr float kTrendKept = 0.7f;  // part that remains after a sub-step
constexpr float kGiven = 0.35f;     // added to the impulse, so that a pile is supported after fewer sub-steps
constexpr float kLent = 0.5f;       // added for one sub-step only, against oscillation
constexpr float kRegular = 1e-3f;   // two points bounce together if their levers differ at least by this
// Values of normal_mass for existing points until the block is finished; kIsGiven: the impulse is given.
constexpr float kExists = 1, kIsGiven = 0.5f;

struct Body {
  Lanes vx, vy, spin, unused;
};
struct Moved {
  Lanes x, y, c, s;
};

Lanes loadLow(const SubstepState& state) {
  Lanes v;
  __builtin_memcpy(&v, &state.vx, sizeof v);
  return v;
}
Lanes loadHigh(const SubstepState& state) {
  Lanes v;
  __builtin_memcpy(&v, &state.x, sizeof v);
  return v;
}

Body gather(std::span<const SubstepState> states, const std::array<std::int32_t, kLanes>& of) {
  Body v = {loadLow(states[at(of[0])]), loadLow(states[at(of[1])]), loadLow(states[at(of[2])]),
            loadLow(states[at(of[3])])};
  transpose(v.vx, v.vy, v.spin, v.unused);
  return v;
}
Moved gatherMoved(std::span<const SubstepState> states, const std::array<std::int32_t, kLanes>& of) {
  Moved m = {loadHigh(states[at(of[0])]), loadHigh(states[at(of[1])]), loadHigh(states[at(of[2])]),
             loadHigh(states[at(of[3])])};
  transpose(m.x, m.y, m.c, m.s);
  return m;
}
void scatter(std::span<SubstepState> states, const std::array<std::int32_t, kLanes>& of, Body v) {
  transpose(v.vx, v.vy, v.spin, v.unused);
  __builtin_memcpy(&states[at(of[0])].vx, &v.vx, sizeof v.vx);
  __builtin_memcpy(&states[at(of[1])].vx, &v.vy, sizeof v.vx);
  __builtin_memcpy(&states[at(of[2])].vx, &v.spin, sizeof v.vx);
  __builtin_memcpy(&states[at(of[3])].vx, &v.unused, sizeof v.vx);
}

}  // namespace

void ContactRows::clear(std::size_t blocks, float h) {
  const auto both = [h](float turns, float damping) {
    return std::array{softnessOf(turns, damping, h), softnessOf(2 * turns, damping, h)};
  };
  m_softness = both(kFastestTurns, kContactDamping);
  m_lasting_softness = both(kLastingTurns, kLastingDamping);
  m_blocks.clear();
  m_driven.clear();
  m_may_bounce = false;
  reserveFor(m_blocks, blocks);
}

void ContactRows::beginBlock() {
  m_blocks.emplace_back();
}

std::int32_t ContactRows::add(const ContactRow& row, const Manifold& manifold, const KnownImpulses& known) {
  Block& block = m_blocks.back();
  const int lane = block.count++;
  block.a[at(lane)] = row.a, block.b[at(lane)] = row.b;
  block.inverse_mass_a[lane] = row.inverse_mass_a, block.inverse_mass_b[lane] = row.inverse_mass_b;
  block.inverse_inertia_a[lane] = row.inverse_inertia_a,
  block.inverse_inertia_b[lane] = row.inverse_inertia_b;
  const Vec2 n = manifold.normal;
  block.nx[lane] = static_cast<float>(n.x), block.ny[lane] = static_cast<float>(n.y);
  block.vx[lane] = static_cast<float>(row.velocity.x), block.vy[lane] = static_cast<float>(row.velocity.y);
  block.spin_a[lane] = row.spin_a, block.spin_b[lane] = row.spin_b;
  block.friction[lane] = row.friction, block.restitution[lane] = row.restitution;
  block.max_push[lane] = row.max_push;
  block.rest[lane] = row.rest;
  block.fast[lane] = row.fast;
  block.bounces = block.bounces || row.restitution > 0;
  const Softness& softness = (row.is_lasting ? m_lasting_softness : m_softness).at(row.is_held ? 1 : 0);
  block.follows[lane] = row.is_lasting ? 1 : 0;
  block.rate[lane] = softness.rate;
  block.mass_scale[lane] = softness.mass_scale;
  block.impulse_scale[lane] = row.is_given ? 0 : softness.impulse_scale;
  block.points = std::max(block.points, manifold.count);
  for (std::int32_t i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& from = manifold.points[at(i)];
    Point& to = block.point[at(i)];
    to.ax[lane] = static_cast<float>(from.anchor_a.x), to.ay[lane] = static_cast<float>(from.anchor_a.y);
    to.bx[lane] = static_cast<float>(from.anchor_b.x), to.by[lane] = static_cast<float>(from.anchor_b.y);
    to.gap[lane] = static_cast<float>(from.separation);
    to.normal_mass[lane] = row.is_given ? kIsGiven : kExists;
    to.normal.set(lane, known.normal[at(i)]);
    to.friction.set(lane, known.friction[at(i)]);
  }
  const auto number = static_cast<std::int32_t>((m_blocks.size() - 1) * kLanes) + lane;
  if (row.is_driven) {
    const bool is_a = row.inverse_mass_a + row.inverse_inertia_a == 0;
    m_driven.push_back({number, is_a ? row.b : row.a, row.driver, is_a ? row.spin_a : row.spin_b, is_a});
  }
  return number;
}

double ContactRows::workOf(const Driven& driven) const {
  const Block& k = m_blocks[at(driven.row) / kLanes];
  const int lane = static_cast<int>(at(driven.row) % kLanes);
  const Vec2 n = {k.nx[lane], k.ny[lane]};
  double work = 0;
  for (const Point& p : k.point) {
    const Vec2 push = double{p.normal.now[lane]} * n + double{p.friction.now[lane]} * perpendicular(n);
    const Vec2 arm = driven.is_a ? Vec2{p.ax[lane], p.ay[lane]} : Vec2{p.bx[lane], p.by[lane]};
    const double along = dot(push, driven.velocity + cross(driven.spin, arm));
    work += driven.is_a ? along : -along;
  }
  return work;
}

void ContactRows::scale(std::span<const float> factors) {
  for (Block& k : m_blocks) {
    for (int lane = 0; lane < k.count; ++lane) {
      const bool moves_a = k.inverse_mass_a[lane] + k.inverse_inertia_a[lane] > 0;
      const float by = factors[at(moves_a ? k.a[at(lane)] : k.b[at(lane)])];
      if (by == 1) continue;
      for (Point& p : k.point) {
        p.total[lane] -= (1 - by) * p.normal.now[lane];
        for (Impulse* const p_impulse : {&p.normal, &p.friction}) {
          p_impulse->now[lane] *= by;
          p_impulse->trend[lane] *= by;
        }
      }
    }
  }
}

void ContactRows::finishBlock() {
  const Lanes zero = {}, one = lanesOf(1);
  Block& k = m_blocks.back();
  m_may_bounce = m_may_bounce || k.bounces;
  const Lanes masses = k.inverse_mass_a + k.inverse_mass_b;
  for (std::int32_t i = 0; i < k.points; ++i) {
    Point& p = k.point[at(i)];
    p.gap_now = p.gap;
    if (k.bounces) {
      p.approach = k.nx * (k.vx - k.spin_b * p.by + k.spin_a * p.ay) +
                   k.ny * (k.vy + k.spin_b * p.bx - k.spin_a * p.ax);
    }
    const Lanes normal_a = p.ax * k.ny - p.ay * k.nx, normal_b = p.bx * k.ny - p.by * k.nx;
    const Lanes tangent_a = p.ax * k.nx + p.ay * k.ny, tangent_b = p.bx * k.nx + p.by * k.ny;
    const Lanes normal =
        masses + k.inverse_inertia_a * normal_a * normal_a + k.inverse_inertia_b * normal_b * normal_b;
    const Lanes tangent =
        masses + k.inverse_inertia_a * tangent_a * tangent_a + k.inverse_inertia_b * tangent_b * tangent_b;
    const LaneMask exists = p.normal_mass > zero;
    p.normal_mass = select((p.normal_mass == lanesOf(kExists)) & (normal > zero), one / normal, zero);
    p.tangent_mass = select(exists & (tangent > zero), one / tangent, zero);
    p.normal.begin();
    p.friction.begin();
  }
}

void ContactRows::Impulse::set(int lane, KnownImpulse known) {
  now[lane] = known.kept;
  trend[lane] = known.trend;
}

void ContactRows::Impulse::begin() {
  trend = trend / kTrendKept;
  now = start = now + kLent * trend;
}

KnownImpulse ContactRows::Impulse::known(int lane) const {
  return {now[lane] - kLent * trend[lane], kTrendKept * trend[lane] + (now[lane] - start[lane])};
}

// Removes the lent part of the old trend and adds both parts of the new trend, within the impulse's bounds.
void ContactRows::Impulse::beginSubstep(Lanes least, Lanes most, Lanes most_trend) {
  const Lanes own = now - kLent * trend;
  trend = kTrendKept * trend + (now - start);
  trend = larger(-most_trend, smaller(trend, most_trend));
  const Lanes kept = larger(least, smaller(own + kGiven * trend, most));
  now = start = larger(least, smaller(kept + kLent * trend, most));
  trend = (1 / kLent) * (now - kept);
}

// Limits the trend to the smaller of the impulses before and after the last sub-step, so a blow has none.
void ContactRows::warmStart(std::span<SubstepState> states) {
  const Lanes unlimited = lanesOf(std::numeric_limits<float>::max());
  for (Block& k : m_blocks) {
    Body a = gather(states, k.a), b = gather(states, k.b);
    for (std::int32_t i = 0; i < k.points; ++i) {
      Point& p = k.point[at(i)];
      const Lanes most_trend = k.follows * smaller(p.normal.start, p.normal.now);
      p.normal.beginSubstep(Lanes{}, unlimited, most_trend);
      const Lanes most = k.friction * p.normal.now;
      p.friction.beginSubstep(-most, most, k.friction * most_trend);
      const Lanes px = p.normal.now * k.nx - p.friction.now * k.ny;
      const Lanes py = p.normal.now * k.ny + p.friction.now * k.nx;
      a.vx -= k.inverse_mass_a * px, a.vy -= k.inverse_mass_a * py;
      a.spin -= k.inverse_inertia_a * (p.ax * py - p.ay * px);
      b.vx += k.inverse_mass_b * px, b.vy += k.inverse_mass_b * py;
      b.spin += k.inverse_inertia_b * (p.bx * py - p.by * px);
    }
    scatter(states, k.a, a);
    scatter(states, k.b, b);
  }
}

// Updates the gaps after the bodies have moved; the levers rotate with their bodies.
void ContactRows::updateGaps(Block& k, std::span<const SubstepState> states, float time) {
  const Moved at_a = gatherMoved(states, k.a), at_b = gatherMoved(states, k.b);
  const Lanes x = at_b.x - at_a.x + time * k.vx, y = at_b.y - at_a.y + time * k.vy;
  for (std::int32_t i = 0; i < k.points; ++i) {
    Point& p = k.point[at(i)];
    const Lanes dx = x + (at_b.c * p.bx - at_b.s * p.by - p.bx) - (at_a.c * p.ax - at_a.s * p.ay - p.ax);
    const Lanes dy = y + (at_b.s * p.bx + at_b.c * p.by - p.by) - (at_a.s * p.ax + at_a.c * p.ay - p.ay);
    p.gap_now = p.gap + dx * k.nx + dy * k.ny;
  }
}

template <bool kIsSoft>
void ContactRows::solveRows(std::span<SubstepState> states, float h, float time) {
  const Lanes zero = {}, one = lanesOf(1), inverse_h = lanesOf(1 / h);
  for (Block& k : m_blocks) {
    Body a = gather(states, k.a), b = gather(states, k.b);
    for (std::int32_t i = 0; i < k.points; ++i) {
      Point& p = k.point[at(i)];
      const Lanes vx = k.vx + (b.vx - b.spin * p.by) - (a.vx - a.spin * p.ay);
      const Lanes vy = k.vy + (b.vy + b.spin * p.bx) - (a.vy + a.spin * p.ax);
      const Lanes slip = vy * k.nx - vx * k.ny;
      const Lanes most = k.friction * p.normal.now;
      const Lanes wanted = p.friction.now - p.tangent_mass * slip;
      const Lanes now = larger(-most, smaller(wanted, most));
      const Lanes change = now - p.friction.now;
      p.friction.now = now;
      const Lanes px = -change * k.ny, py = change * k.nx;
      a.vx -= k.inverse_mass_a * px, a.vy -= k.inverse_mass_a * py;
      a.spin -= k.inverse_inertia_a * (p.ax * py - p.ay * px);
      b.vx += k.inverse_mass_b * px, b.vy += k.inverse_mass_b * py;
      b.spin += k.inverse_inertia_b * (p.bx * py - p.by * px);
    }
    if constexpr (!kIsSoft) updateGaps(k, states, time);
    for (std::int32_t i = 0; i < k.points; ++i) {
      Point& p = k.point[at(i)];
      const Lanes gap = p.gap_now;
      const LaneMask is_open = gap > zero;
      const Lanes soft_bias = kIsSoft ? larger(k.rate * gap, -k.max_push) : zero;
      const Lanes bias = select(is_open, gap * inverse_h, soft_bias);
      const Lanes vx = k.vx + (b.vx - b.spin * p.by) - (a.vx - a.spin * p.ay);
      const Lanes vy = k.vy + (b.vy + b.spin * p.bx) - (a.vy + a.spin * p.ax);
      const Lanes speed = vx * k.nx + vy * k.ny;
      // Fast approaches are stopped without softness, because with the speed that softness leaves, the body
      // would pass through. The limit is lower for lasting contacts, for which a blow already counts as fast.
      const LaneMask is_hard = is_open | (speed < -k.fast);
      const Lanes mass_scale = kIsSoft ? select(is_hard, one, k.mass_scale) : one;
      const Lanes impulse_scale = kIsSoft ? select(is_hard, zero, k.impulse_scale) : zero;
      const Lanes wanted =
          p.normal.now - p.normal_mass * mass_scale * (speed + bias) - impulse_scale * p.normal.now;
      const Lanes now = larger(wanted, zero);
      const Lanes change = now - p.normal.now;
      p.normal.now = now;
      const Lanes px = change * k.nx, py = change * k.ny;
      a.vx -= k.inverse_mass_a * px, a.vy -= k.inverse_mass_a * py;
      a.spin -= k.inverse_inertia_a * (p.ax * py - p.ay * px);
      b.vx += k.inverse_mass_b * px, b.vy += k.inverse_mass_b * py;
      b.spin += k.inverse_inertia_b * (p.bx * py - p.by * px);
      // An impulse of the soft solution counts as a touch, too, even if relaxation removes it.
      k.first = select((now > zero) & (k.first < zero), lanesOf(time), k.first);
      if constexpr (!kIsSoft) p.total += now;
    }
    scatter(states, k.a, a);
    scatter(states, k.b, b);
  }
}

template void ContactRows::solveRows<true>(std::span<SubstepState>, float, float);
template void ContactRows::solveRows<false>(std::span<SubstepState>, float, float);

void ContactRows::bounce(std::span<SubstepState> states) {
  const Lanes zero = {}, one = lanesOf(1);
  for (Block& k : m_blocks) {
    if (!k.bounces) continue;
    const auto isHit = [&](const Point& p) {
      return (k.restitution > zero) & (p.total > zero) & (p.approach < -k.rest);
    };
    const LaneMask is_any = isHit(k.point[0]) | isHit(k.point[1]);
    if ((is_any[0] | is_any[1] | is_any[2] | is_any[3]) == 0) continue;
    Body a = gather(states, k.a), b = gather(states, k.b);
    const auto missing = [&](const Point& p) {
      const Lanes vx = k.vx + (b.vx - b.spin * p.by) - (a.vx - a.spin * p.ay);
      const Lanes vy = k.vy + (b.vy + b.spin * p.bx) - (a.vy + a.spin * p.ax);
      return -(vx * k.nx + vy * k.ny + k.restitution * p.approach);
    };
    const auto add = [&](Point& p, Lanes change) {
      p.normal.now += change;
      p.total += change;
      const Lanes px = change * k.nx, py = change * k.ny;
      a.vx -= k.inverse_mass_a * px, a.vy -= k.inverse_mass_a * py;
      a.spin -= k.inverse_inertia_a * (p.ax * py - p.ay * px);
      b.vx += k.inverse_mass_b * px, b.vy += k.inverse_mass_b * py;
      b.spin += k.inverse_inertia_b * (p.bx * py - p.by * px);
    };
    LaneMask is_done = zero > zero;
    if (k.points == 2) {  // solved together, because one after the other would leave a spin
      Point &p = k.point[0], &q = k.point[1];
      const Lanes own_p = one / p.normal_mass, own_q = one / q.normal_mass;
      const Lanes both = k.inverse_mass_a + k.inverse_mass_b +
                         k.inverse_inertia_a * (p.ax * k.ny - p.ay * k.nx) * (q.ax * k.ny - q.ay * k.nx) +
                         k.inverse_inertia_b * (p.bx * k.ny - p.by * k.nx) * (q.bx * k.ny - q.by * k.nx);
      const Lanes determinant = own_p * own_q - both * both;
      const Lanes by_p = missing(p), by_q = missing(q);
      const Lanes at_p = (own_q * by_p - both * by_q) / determinant;
      const Lanes at_q = (own_p * by_q - both * by_p) / determinant;
      is_done = isHit(p) & isHit(q) & (determinant > lanesOf(kRegular) * own_p * own_q) &
                (p.normal_mass > zero) & (q.normal_mass > zero) & (p.normal.now + at_p >= zero) &
                (q.normal.now + at_q >= zero);
      add(p, select(is_done, at_p, zero));
      add(q, select(is_done, at_q, zero));
    }
    for (std::int32_t i = 0; i < k.points; ++i) {
      Point& p = k.point[at(i)];
      const Lanes change = larger(p.normal_mass * missing(p), -p.normal.now);
      add(p, select(isHit(p) & ~is_done, change, zero));
    }
    scatter(states, k.a, a);
    scatter(states, k.b, b);
  }
}

float ContactRows::normalImpulse(std::int32_t row, int point) const {
  return m_blocks[at(row) / kLanes].point[at(point)].normal.now[at(row) % kLanes];
}

void ContactRows::setNormalImpulse(std::int32_t row, int point, float impulse) {
  m_blocks[at(row) / kLanes].point[at(point)].normal.now[at(row) % kLanes] = impulse;
}

float ContactRows::bounceSpeed(std::int32_t row, int point) const {
  const Block& k = m_blocks[at(row) / kLanes];
  const Point& p = k.point[at(point)];
  const int lane = static_cast<int>(at(row) % kLanes);
  const bool is_hit =
      k.bounces && k.restitution[lane] > 0 && p.total[lane] > 0 && p.approach[lane] < -k.rest[lane];
  return is_hit ? -k.restitution[lane] * p.approach[lane] : 0;
}

ContactPush ContactRows::read(std::int32_t row, KnownImpulses& known) const {
  const Block& k = m_blocks[at(row) / kLanes];
  const int lane = static_cast<int>(at(row) % kLanes);
  ContactPush pushed;
  pushed.first = k.first[lane];
  for (std::size_t i = 0; i < 2; ++i) {
    known.normal[i] = k.point[i].normal.known(lane);
    known.normal[i].kept = std::max(known.normal[i].kept, 0.0f);
    known.friction[i] = k.point[i].friction.known(lane);
    pushed.total += k.point[i].total[lane];
  }
  return pushed;
}

}  // namespace naiad::physics
