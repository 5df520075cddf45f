#include "physics/rigid/RigidSolver.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr double kPushRate = 0.3;  // fraction of an overlap undone in a sub-step
// A bounce slower than the speed gained in this many sub-steps ends at rest: its flight is too short.
constexpr double kRestSteps = 2;
constexpr double kBend = 1e-6;            // part of the impact speed: more rotation spoils the parabola
constexpr double kTouching = 100;         // times the slop: with a smaller gap, a point touches
constexpr double kSpeedRounding = 1e-15;  // part of the speeds
constexpr int kImpactRounds = 16;    // bounces of the points of an impact in turn, before they end at rest
constexpr double kAnySpeed = -1e12;  // a target speed that every contact exceeds, so it does not push

/// The part of a body's state that a contact changes, in registers while the contact is solved.
struct Pushed {
  explicit Pushed(const RigidState& state)
      : velocity(state.velocity),
        spin(state.spin),
        inverse_mass(state.inverse_mass),
        inverse_inertia(state.inverse_inertia) {}
  void store(RigidState& state) const {
    state.velocity = velocity;
    state.spin = spin;
  }

  Vec2 velocity;
  double spin, inverse_mass, inverse_inertia;
};

template <class Body>
double normalSpeed(const ContactPoint& p, Vec2 n, const Body& a, const Body& b) {
  return dot(n, b.velocity - a.velocity) + (p.normal_b * b.spin - p.normal_a * a.spin);
}

template <class Body>
double slipSpeed(const ContactPoint& p, Vec2 t, const Body& a, const Body& b) {
  return dot(t, b.velocity - a.velocity) + (p.tangent_b * b.spin - p.tangent_a * a.spin);
}

template <class Body>
void push(Body& a, Body& b, Vec2 direction, double lever_a, double lever_b, double impulse) {
  a.velocity -= (a.inverse_mass * impulse) * direction;
  a.spin -= a.inverse_inertia * lever_a * impulse;
  b.velocity += (b.inverse_mass * impulse) * direction;
  b.spin += b.inverse_inertia * lever_b * impulse;
}

void pushPoint(const ContactConstraint& c, const ContactPoint& p, RigidState& a, RigidState& b,
               double normal_impulse, double friction_impulse) {
  push(a, b, c.normal, p.normal_a, p.normal_b, normal_impulse);
  push(a, b, perpendicular(c.normal), p.tangent_a, p.tangent_b, friction_impulse);
}

// Sets the levers and masses of a point whose positions relative to the centres are `arm_a` and `arm_b`.
void setLevers(ContactPoint& p, Vec2 n, Vec2 arm_a, Vec2 arm_b, const RigidState& a, const RigidState& b) {
  const Vec2 t = perpendicular(n);
  p.normal_a = cross(arm_a, n), p.normal_b = cross(arm_b, n);
  p.tangent_a = cross(arm_a, t), p.tangent_b = cross(arm_b, t);
  const double mass = a.inverse_mass + b.inverse_mass;
  const double normal =
      mass + a.inverse_inertia * p.normal_a * p.normal_a + b.inverse_inertia * p.normal_b * p.normal_b;
  const double tangent =
      mass + a.inverse_inertia * p.tangent_a * p.tangent_a + b.inverse_inertia * p.tangent_b * p.tangent_b;
  p.normal_mass = normal > 0 ? 1 / normal : 0;
  p.normal_resistance = p.normal_mass > 0 ? 1 / p.normal_mass : 0;
  p.tangent_mass = tangent > 0 ? 1 / tangent : 0;
}

// Prepares the two normals of a manifold for their solution as one system, unless they are nearly dependent.
void setPair(ContactConstraint& c, const RigidState& a, const RigidState& b) {
  c.inverse_determinant = 0;
  if (c.count < 2) return;
  const ContactPoint &p = c.points[0], &q = c.points[1];
  c.coupling = a.inverse_mass + b.inverse_mass + a.inverse_inertia * p.normal_a * q.normal_a +
               b.inverse_inertia * p.normal_b * q.normal_b;
  if (p.normal_mass == 0 || q.normal_mass == 0) return;
  const double product = 1 / (p.normal_mass * q.normal_mass);
  const double determinant = product - c.coupling * c.coupling;
  if (determinant > 1e-3 * product) c.inverse_determinant = 1 / determinant;
}

// Predicts the bounce of a point that is about to touch. It moves along the normal with constant
// acceleration, so its position and speed at the end of the sub-step are known.
void foreseeBounce(const ContactConstraint& c, ContactPoint& p, const RigidState& a, const RigidState& b,
                   double h, double rest) {
  const double speed = normalSpeed(p, c.normal, a, b), gap = std::max(p.separation, 0.0);
  const double gain =
      2 / h * (dot(c.normal, b.kick - a.kick) + p.normal_b * b.spin_kick - p.normal_a * a.spin_kick);
  const double square = speed * speed - 2 * gain * gap;
  if (!(square > 0)) return;
  const double impact = std::sqrt(square);  // the speed of approach when they touch
  const double time = speed < 0 ? 2 * gap / (impact - speed) : gain < 0 ? -(speed + impact) / gain : h;
  const double leaving = c.restitution * impact;
  if (!(time < h) || !(leaving > rest)) return;
  // Speed by rotation, which is present or which the bounce causes.
  const double turning =
      std::fabs(p.normal_a * a.spin) + std::fabs(p.normal_b * b.spin) +
      impact * p.normal_mass *
          (p.normal_a * p.normal_a * a.inverse_inertia + p.normal_b * p.normal_b * b.inverse_inertia);
  if (c.may_fly && turning > kBend * impact) {
    p.is_bending = true;
    return;
  }
  const double left = h - time;
  p.is_bouncing = true;
  p.after = leaving + gain * left;
  p.target = ((leaving + 0.5 * gain * left) * left - p.separation) / h;
}

// True if the contact neither presses nor rests, and its points may approach too fast to come to rest.
bool isBallistic(const ContactConstraint& c, const RigidState& a, const RigidState& b, double rest) {
  const double straight = length(b.velocity - a.velocity);
  bool is_fast = false;
  for (std::int32_t i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[at(i)];
    const bool rests = p.separation <= kTouching * c.slop &&
                       c.restitution * std::fabs(normalSpeed(p, c.normal, a, b)) <= rest;
    if (p.normal_impulse > 0 || rests) return false;
    const double most = straight + std::fabs(a.spin) * length(Vec2{p.normal_a, p.tangent_a}) +
                        std::fabs(b.spin) * length(Vec2{p.normal_b, p.tangent_b});
    is_fast = is_fast || c.restitution * most > rest;
  }
  return is_fast;
}

[[gnu::always_inline]] inline void solveFriction(ContactConstraint& c, Pushed& a, Pushed& b) {
  const Vec2 t = perpendicular(c.normal);
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    const double most = c.friction * p.normal_impulse;
    const double wanted = p.friction_impulse - p.tangent_mass * slipSpeed(p, t, a, b);
    const double impulse = std::clamp(wanted, -most, most), more = impulse - p.friction_impulse;
    p.friction_impulse = impulse;
    push(a, b, t, p.tangent_a, p.tangent_b, more);
  }
}

[[gnu::always_inline]] inline double solveOne(ContactConstraint& c, ContactPoint& p, double target, Pushed& a,
                                              Pushed& b) {
  const double missing = target - normalSpeed(p, c.normal, a, b);
  const double impulse = std::max(p.normal_impulse + p.normal_mass * missing, 0.0);
  const double more = impulse - p.normal_impulse;
  p.normal_impulse = impulse;
  push(a, b, c.normal, p.normal_a, p.normal_b, more);
  return p.normal_mass > 0 ? std::fabs(more) / p.normal_mass : 0;
}

// Solves the complementarity problem of two points by a test of its four cases.
[[gnu::always_inline]] inline double solveTwo(ContactConstraint& c, double target_p, double target_q,
                                              Pushed& a, Pushed& b) {
  ContactPoint &p = c.points[0], &q = c.points[1];
  const double kp = p.normal_resistance, kq = q.normal_resistance;
  const double missing_p = target_p - normalSpeed(p, c.normal, a, b);
  const double missing_q = target_q - normalSpeed(q, c.normal, a, b);
  // The speeds that would be missing if neither point pushed.
  const double rp = missing_p + kp * p.normal_impulse + c.coupling * q.normal_impulse;
  const double rq = missing_q + c.coupling * p.normal_impulse + kq * q.normal_impulse;
  // First tries to change the present impulses, so that nothing changes if no speed is missing.
  double x = p.normal_impulse + c.inverse_determinant * (kq * missing_p - c.coupling * missing_q);
  double y = q.normal_impulse + c.inverse_determinant * (kp * missing_q - c.coupling * missing_p);
  if (!(x >= 0 && y >= 0)) {
    x = std::max(rp * p.normal_mass, 0.0), y = 0;
    if (c.coupling * x < rq) {
      x = 0, y = std::max(rq * q.normal_mass, 0.0);
      if (c.coupling * y < rp) x = std::max(rp * p.normal_mass, 0.0);  // possible only by rounding
    }
  }
  const double more_p = x - p.normal_impulse, more_q = y - q.normal_impulse;
  p.normal_impulse = x, q.normal_impulse = y;
  const double sum = more_p + more_q;
  a.velocity -= (a.inverse_mass * sum) * c.normal;
  a.spin -= a.inverse_inertia * (p.normal_a * more_p + q.normal_a * more_q);
  b.velocity += (b.inverse_mass * sum) * c.normal;
  b.spin += b.inverse_inertia * (p.normal_b * more_p + q.normal_b * more_q);
  return std::max(std::fabs(more_p) * kp, std::fabs(more_q) * kq);
}

[[gnu::always_inline]] inline double solveNormals(ContactConstraint& c, Pushed& a, Pushed& b,
                                                  bool is_second) {
  const auto target = [&](std::size_t i) { return is_second ? c.points[i].after : c.points[i].target; };
  if (c.inverse_determinant > 0) return solveTwo(c, target(0), target(1), a, b);
  double change = 0;
  for (std::int32_t i = 0; i < c.count; ++i) {
    change = std::max(change, solveOne(c, c.points[at(i)], target(at(i)), a, b));
  }
  return change;
}

}  // namespace

void beginConstraint(const RotatedShape& a, const RotatedShape& b, Vec2 offset, const Manifold& manifold,
                     ContactConstraint& c) {
  c.count = manifold.count;
  c.normal = c.first_normal = manifold.normal;
  c.offset = offset;
  c.radius_a = a.radius, c.radius_b = b.radius;
  c.first_time = -1;
  c.overlaps = false;
  c.first_gap = manifold.points[0].separation;
  const std::uint32_t id = manifold.points[0].id;
  using Owner = ReferenceFace::Owner;
  c.kind = manifold.reference.owner == Owner::kA                    ? ContactKind::kFaceA
           : manifold.reference.owner == Owner::kB                  ? ContactKind::kFaceB
           : a.count > 1 && manifold.normal == a.normals[id >> 8]   ? ContactKind::kFaceA
           : b.count > 1 && manifold.normal == -b.normals[id & 255] ? ContactKind::kFaceB
                                                                    : ContactKind::kPoints;
  for (std::int32_t i = 0; i < c.count; ++i) {
    const ManifoldPoint& from = manifold.points[at(i)];
    ContactPoint& p = c.points[at(i)];
    p = {};
    p.id = from.id;
    p.separation = from.separation;
    c.overlaps = c.overlaps || p.separation < -c.slop;
    c.first_gap = std::min(c.first_gap, p.separation);
    p.core_a = from.anchor_a - (a.radius + 0.5 * from.separation) * c.normal;
    p.core_b = from.anchor_b + (b.radius + 0.5 * from.separation) * c.normal;
    switch (c.kind) {
      case ContactKind::kFaceA:
        p.base = from.separation - dot(c.normal, offset + p.core_b);
        break;
      case ContactKind::kFaceB:
        p.base = from.separation - dot(c.normal, offset - p.core_a);
        break;
      case ContactKind::kPoints:
        p.base = from.separation - length(offset + p.core_b - p.core_a);
        break;
    }
  }
}

void measureFromStart(ContactConstraint& c, Vec2 start, const RigidState& a, const RigidState& b) {
  c.offset = start;
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    p.core_a = inverse(a.turn) * p.core_a;
    p.core_b = inverse(b.turn) * p.core_b;
  }
  if (c.kind == ContactKind::kFaceA) c.first_normal = inverse(a.turn) * c.first_normal;
  if (c.kind == ContactKind::kFaceB) c.first_normal = inverse(b.turn) * c.first_normal;
}

void refresh(ContactConstraint& c, std::span<const RigidState> bodies) {
  const RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  const Vec2 apart = c.offset + (b.displacement - a.displacement);
  if (c.kind == ContactKind::kFaceA) c.normal = a.turn * c.first_normal;
  if (c.kind == ContactKind::kFaceB) c.normal = b.turn * c.first_normal;
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    Vec2 arm_a, arm_b;
    if (c.kind == ContactKind::kFaceA) {
      const Vec2 core = b.turn * p.core_b;
      p.separation = p.base + dot(c.normal, apart + core);
      arm_b = core - (c.radius_b + 0.5 * p.separation) * c.normal;
      arm_a = apart + arm_b;
    } else if (c.kind == ContactKind::kFaceB) {
      const Vec2 core = a.turn * p.core_a;
      p.separation = p.base + dot(c.normal, apart - core);
      arm_a = core + (c.radius_a + 0.5 * p.separation) * c.normal;
      arm_b = arm_a - apart;
    } else {
      const Vec2 core = a.turn * p.core_a, between = apart + b.turn * p.core_b - core;
      const double distance = length(between);
      p.separation = p.base + distance;
      if (distance > 1e-9) c.normal = between / distance;
      arm_a = core + (c.radius_a + 0.5 * p.separation) * c.normal;
      arm_b = arm_a - apart;
    }
    setLevers(p, c.normal, arm_a, arm_b, a, b);
  }
  setPair(c, a, b);
}

bool beginSubstep(ContactConstraint& c, std::span<const RigidState> bodies, double h) {
  const RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  bool is_deep = false;
  const double rest = c.restitution > 0 ? restSpeed(c, bodies) : 0;
  c.is_ballistic = c.restitution > 0 && c.may_fly && isBallistic(c, a, b, rest);
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    p.is_bouncing = p.is_bending = false;
    if (c.restitution > 0 && !c.is_ballistic) foreseeBounce(c, p, a, b, h, rest);
    if (!p.is_bouncing) {
      p.target = c.is_ballistic || p.is_bending ? kAnySpeed : p.separation > 0 ? -p.separation / h : 0;
    }
    // A point without overlap has a limit, too, so that the push of other points does not make it overlap.
    p.push = p.separation < -c.slop ? std::min(-kPushRate * (p.separation + c.slop) / h, c.max_push_speed)
                                    : -(p.separation + c.slop) / h;
    if (c.is_ballistic && !c.overlaps) p.push = kAnySpeed;
    p.push_impulse = 0;
    is_deep = is_deep || p.push > 0;
    p.normal_warm = p.normal_impulse = 0.5 * p.normal_impulse;
    p.friction_warm = p.friction_impulse = 0.5 * p.friction_impulse;
  }
  c.is_deep = is_deep;
  return is_deep;
}

void pushApart(ContactConstraint& c, std::span<RigidState> bodies) {
  RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  if (!c.is_deep && !a.is_pushed && !b.is_pushed) return;
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    const double speed =
        dot(c.normal, b.push - a.push) + (p.normal_b * b.push_spin - p.normal_a * a.push_spin);
    const double impulse = std::max(p.push_impulse + p.normal_mass * (p.push - speed), 0.0);
    const double more = impulse - p.push_impulse;
    if (more == 0) continue;
    p.push_impulse = impulse;
    a.push -= (a.inverse_mass * more) * c.normal;
    a.push_spin -= a.inverse_inertia * p.normal_a * more;
    b.push += (b.inverse_mass * more) * c.normal;
    b.push_spin += b.inverse_inertia * p.normal_b * more;
    a.is_pushed = a.inverse_mass > 0 || a.inverse_inertia > 0;
    b.is_pushed = b.inverse_mass > 0 || b.inverse_inertia > 0;
  }
}

void beginFirstHalf(ContactConstraint& c, std::span<RigidState> bodies) {
  c.before = {};
  RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  for (std::int32_t i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[at(i)];
    pushPoint(c, p, a, b, p.normal_warm, p.friction_warm);
  }
}

void beginSecondHalf(ContactConstraint& c, std::span<RigidState> bodies, double h) {
  RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  const ContactPoint &one = c.points[0], &two = c.points[1];
  c.before = {one.normal_impulse, two.normal_impulse, one.friction_impulse, two.friction_impulse};
  for (std::int32_t i = 0; i < c.count; ++i) {
    ContactPoint& p = c.points[at(i)];
    if (!p.is_bouncing) {
      p.after = c.is_ballistic ? kAnySpeed : 0;
      if (p.separation > 0 && !c.is_ballistic) {
        p.after = -p.separation / h;
        if (c.restitution > 0 && p.normal_impulse == 0) {  // it will bounce in the next sub-step
          p.after = kAnySpeed;
          p.normal_warm = p.friction_warm = 0;
        }
      }
    }
    p.normal_impulse += p.normal_warm;
    p.friction_impulse += p.friction_warm;
    pushPoint(c, p, a, b, p.normal_warm, p.friction_warm);
  }
}

void dropGuess(ContactConstraint& c) {
  for (ContactPoint& p : c.points) {
    p.normal_impulse = p.friction_impulse = p.normal_warm = p.friction_warm = 0;
  }
}

void restart(ContactConstraint& c, std::span<RigidState> bodies, double part) {
  for (std::size_t i = 0; i < at(c.count); ++i) {
    ContactPoint& p = c.points[i];
    const double normal = part * p.normal_warm, friction = part * p.friction_warm;
    p.normal_impulse = c.before[i] + normal;
    p.friction_impulse = c.before[i + 2] + friction;
    pushPoint(c, p, bodies[at(c.a)], bodies[at(c.b)], normal, friction);
  }
}

void scale(ContactConstraint& c, double part) {
  for (std::size_t i = 0; i < at(c.count); ++i) {
    ContactPoint& p = c.points[i];
    p.normal_impulse = c.before[i] + part * (p.normal_impulse - c.before[i]);
    p.friction_impulse = c.before[i + 2] + part * (p.friction_impulse - c.before[i + 2]);
  }
}

double inputOf(const ContactConstraint& c, std::span<const RigidState> bodies) {
  const auto driven = [](const RigidState& s) {
    Pushed part(s);
    if (s.inverse_mass > 0) part.velocity = {};
    if (s.inverse_inertia > 0) part.spin = 0;
    return part;
  };
  const Pushed a = driven(bodies[at(c.a)]), b = driven(bodies[at(c.b)]);
  double input = 0;
  for (std::size_t i = 0; i < at(c.count); ++i) {
    const ContactPoint& p = c.points[i];
    input -= (p.normal_impulse - c.before[i]) * normalSpeed(p, c.normal, a, b) +
             (p.friction_impulse - c.before[i + 2]) * slipSpeed(p, perpendicular(c.normal), a, b);
  }
  return input;
}

// Bodies that fall together do not accelerate each other, but rest on those that others hold up: the pull of
// either body counts, in any direction once they touch. Elastic bodies never come to rest on each other.
double restSpeed(const ContactConstraint& c, std::span<const RigidState> bodies) {
  const RigidState &a = bodies[at(c.a)], &b = bodies[at(c.b)];
  const auto pull = [&](const RigidState& s) {
    return c.is_kept ? length(s.kick) : std::fabs(dot(c.normal, s.kick));
  };
  const double apart = dot(c.normal, b.kick - a.kick);
  double most = c.restitution < 1 ? std::max(pull(a), pull(b)) : 0;
  for (std::int32_t i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[at(i)];
    most = std::max(most, std::fabs(apart + p.normal_b * b.spin_kick - p.normal_a * a.spin_kick));
  }
  return 2 * kRestSteps * most;
}

bool bounce(ContactConstraint& c, std::span<RigidState> bodies, double rest_speed, double rest_after) {
  RigidState &state_a = bodies[at(c.a)], &state_b = bodies[at(c.b)];
  Pushed a(state_a), b(state_b);
  const std::size_t count = at(c.count);
  std::array<double, 2> sum = {};
  bool rests = false;
  for (int round = 0; round <= kImpactRounds; ++round) {
    const double e = round < kImpactRounds || c.restitution == 1 ? c.restitution : 0;
    std::array<double, 2> approach = {};
    for (std::size_t i = 0; i < count; ++i) {
      ContactPoint& p = c.points[i];
      const double speed = -normalSpeed(p, c.normal, a, b);
      const double all = length(a.velocity) + length(b.velocity) + std::fabs(p.normal_a * a.spin) +
                         std::fabs(p.normal_b * b.spin);
      approach[i] = speed > kSpeedRounding * all ? speed : 0;
      const bool leaves = e * speed > rest_speed;
      p.after = leaves ? e * speed : rest_after;
      rests = rests || (approach[i] > 0 && !leaves);
      p.normal_impulse = 0;
    }
    if (approach[0] == 0 && approach[1] == 0) break;
    if (approach[0] > 0 && approach[1] > 0 && c.inverse_determinant > 0) {
      solveTwo(c, c.points[0].after, c.points[1].after, a, b);
    } else {
      ContactPoint& p = c.points[approach[1] > approach[0]];
      solveOne(c, p, p.after, a, b);
    }
    for (std::size_t i = 0; i < count; ++i) sum[i] += c.points[i].normal_impulse;
    if (c.points[0].normal_impulse == 0 && c.points[1].normal_impulse == 0) break;
  }
  for (std::size_t i = 0; i < count; ++i) c.points[i].normal_impulse = sum[i];
  a.store(state_a);
  b.store(state_b);
  return rests;
}

double solveContact(ContactConstraint& c, std::span<RigidState> bodies, bool is_second) {
  RigidState &state_a = bodies[at(c.a)], &state_b = bodies[at(c.b)];
  Pushed a(state_a), b(state_b);
  if (c.friction > 0) {
    // Friction needs normal impulses, so these are found first.
    const ContactPoint &p = c.points[0], &q = c.points[1];
    if (p.normal_warm + q.normal_warm == 0) {
      const double change = solveNormals(c, a, b, is_second);
      const bool is_idle = p.normal_impulse == 0 && q.normal_impulse == 0 && change == 0 &&
                           p.friction_impulse == 0 && q.friction_impulse == 0;
      if (is_idle) return 0;
    }
    solveFriction(c, a, b);
  }
  const double change = solveNormals(c, a, b, is_second);
  a.store(state_a);
  b.store(state_b);
  return change;
}

}  // namespace naiad::physics
