// A SubstepWorld's step: its sub-steps, and what moves too fast for them.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "physics/geometry/TimeOfImpact.h"
#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

constexpr double kFarthest = 1e9;  // metric cells in a step: the limit of timeOfImpact()
constexpr double kMaxTurn = 40;    // rad in a step that are swept: bounds the iterations of timeOfImpact()
// In thicknesses of a body.
constexpr double kSlack = 0.02;       // least margin of the search for contacts
constexpr double kSlow = 0.1;         // in a step: contacts are searched for as far as it and others may get
constexpr double kMaxPass = 0.5;      // that it may go beyond what was searched: its centre passes nothing
constexpr double kCore = 0.5;         // radius of the middle of a body that is swept against what it pushes
constexpr double kBoundsSlack = 0.2;  // by which the tree's bounds are wider: small moves leave them alone

constexpr double kHeld = 0.05;  // of a magnet's push on a body, that is left
constexpr double kAhead = 1;    // … and further in the direction in which it goes, at most
constexpr double kTicksAhead = 2;
constexpr double kNeverKept = kAhead + 2 * kBoundsSlack;  // at that speed it leaves its bounds in any case

// How far turning moves a corner in this step.
double rollOf(const SubstepBody& b) {
  return b.state == 0 ? 0 : std::min(std::fabs(b.turn), 2.0) * b.reach;
}

Vec2 accelerationOf(const RigidBody& body) {
  return body.inverse_mass > 0 ? body.acceleration + body.inverse_mass * body.force : Vec2{};
}
double spinGainOf(const RigidBody& body) {
  return body.inverse_inertia > 0 ? body.inverse_inertia * body.torque : 0;
}

SweptBox relativeTo(const Place& origin, const GridBounds& bounds) {
  const std::int64_t x = origin.cell_x * kGridUnits, y = origin.cell_y * kGridUnits;
  return {{static_cast<double>(bounds.lower_x - x), static_cast<double>(bounds.lower_y - y)},
          {static_cast<double>(bounds.upper_x - x), static_cast<double>(bounds.upper_y - y)}};
}

}  // namespace

void SubstepWorld::listActive() {
  if (!m_active_changed) return;
  m_active_changed = false;
  m_active.clear();
  m_is_shuffled = false;
  std::array<std::uint64_t, 2> last = {};  // of what moves, and of what does not
  for (int id = 0; id < idLimit(); ++id) {
    SubstepBody& b = m_bodies[at(id)];
    b.state = 0;
    if (b.exists) {
      std::uint64_t& before = last[isMovable(b) ? 0 : 1];
      m_is_shuffled = m_is_shuffled || b.order < before;
      before = b.order;
    }
    if (!b.exists || b.is_frozen || b.is_asleep) continue;
    if (isMovable(b) || b.body.velocity != Vec2{} || b.body.spin != 0) m_active.push_back(id);
  }
  if (!m_is_shuffled) return;
  std::sort(m_active.begin(), m_active.end(),
            [&](int x, int y) { return m_bodies[at(x)].order < m_bodies[at(y)].order; });
}

void SubstepWorld::begin(int id) {
  SubstepBody& b = m_bodies[at(id)];
  const RigidBody& body = b.body;
  const Vec2 acceleration = accelerationOf(body);
  const double spin_gain = spinGainOf(body);
  const double path = length(body.velocity) + length(acceleration);
  const double angle = std::fabs(body.spin) + std::fabs(spin_gain);
  if (!(path < kFarthest && angle < kFarthest)) return freeze(id);
  b.state = static_cast<std::int32_t>(m_states.size());
  SubstepState& state = m_states.emplace_back();
  state.spin = static_cast<float>(body.spin);
  b.turn = 0;
  b.part = 1;
  b.colours = b.held_colours = 0;
  b.inverse_mass = inverseOf(body.inverse_mass);
  b.inverse_inertia = inverseOf(body.inverse_inertia);
  b.kick = {static_cast<float>(m_h * acceleration.x), static_cast<float>(m_h * acceleration.y),
            static_cast<float>(m_h * spin_gain)};
  m_kicks.push_back(b.kick);
  if (body.turn_rate != 0 && body.inverse_mass > 0) m_magnets.push_back({id, {}, {}});
  if (b.proxy < 0) return;
  forecast(b);
  boundNow(b);
  m_broad.move(b.proxy, gridBounds(body.place, b.box, b.margin), wideBounds(b));
}

// How far it gets on its own.
void SubstepWorld::forecast(SubstepBody& b) const {
  const double angle = std::fabs(b.body.spin) + std::fabs(spinGainOf(b.body));
  b.drift = b.body.velocity + 0.5 * accelerationOf(b.body);
  b.roll = std::min(angle, 2.0) * b.reach;
  const double movement = length(b.drift) + b.roll;
  b.margin = std::min(movement, b.thickness) + kSlack * b.thickness;
  b.is_busy = !isMovable(b) || movement <= kSlow * b.thickness || b.pushed_at + 1 == m_counters.ticks;
}

// Two bodies whose gap is wider do not meet, unless something pushes one of them.
double SubstepWorld::calmMargin(const SubstepBody& a, const SubstepBody& b) {
  return length(b.drift - a.drift) + a.roll + b.roll + kSlack * (a.thickness + b.thickness);
}

// Room for the moves of the next steps.
GridBounds SubstepWorld::wideBounds(const SubstepBody& b) {
  const double most = kAhead * b.thickness;
  const double speed = std::max(std::fabs(b.body.velocity.x), std::fabs(b.body.velocity.y));
  if (speed > kNeverKept * b.thickness) return gridBounds(b.body.place, b.box, b.margin);
  const Vec2 ahead = {std::clamp(kTicksAhead * b.body.velocity.x, -most, most),
                      std::clamp(kTicksAhead * b.body.velocity.y, -most, most)};
  const Bounds swept = {b.box.lower + Vec2{std::min(ahead.x, 0.0), std::min(ahead.y, 0.0)},
                        b.box.upper + Vec2{std::max(ahead.x, 0.0), std::max(ahead.y, 0.0)}};
  return gridBounds(b.body.place, swept, b.margin + kBoundsSlack * b.thickness);
}

void SubstepWorld::pushByMagnets() {
  for (Magnet& magnet : m_magnets) {
    const SubstepBody& b = m_bodies[at(magnet.id)];
    SubstepState& s = m_states[at(b.state)];
    magnet.turn = magnetTurn(b.body.velocity + Vec2{s.vx, s.vy}, b.body.turn_rate, double{m_h});
    s.vx += static_cast<float>(magnet.turn.push.x), s.vy += static_cast<float>(magnet.turn.push.y);
    magnet.given += magnet.turn.push;
  }
}

void SubstepWorld::undoMagnetWork() {
  for (Magnet& magnet : m_magnets) {
    const SubstepBody& b = m_bodies[at(magnet.id)];
    SubstepState& s = m_states[at(b.state)];
    const Vec2 velocity = b.body.velocity + Vec2{s.vx, s.vy};
    const Vec2 right = withoutWork(magnet.turn, velocity, kHeld);
    const Vec2 gained = right - b.body.velocity;
    s.vx = static_cast<float>(gained.x), s.vy = static_cast<float>(gained.y);
    magnet.given += right - velocity;
  }
}

// The rotation by the half angle's tangent: of length one for any angle.
void SubstepWorld::moveStates() {
  for (std::size_t i = 1; i < m_states.size(); ++i) {
    SubstepState& s = m_states[i];
    s.x += m_h * s.vx, s.y += m_h * s.vy;
    const float angle = m_h * s.spin;
    m_turns[i] += double{angle};
    const float square = 0.25f * angle * angle;
    const float by = 1 / (1 + square);
    const float cosine = (1 - square) * by, sine = angle * by;
    const float c = cosine * s.c - sine * s.s;
    s.s = sine * s.c + cosine * s.s;
    s.c = c;
  }
}

void SubstepWorld::stepOnce() {
  m_events.clear();
  ++m_counters.ticks;
  m_h = 1 / static_cast<float>(m_options.substeps);
  wakeChanged();
  listActive();
  m_states.assign(1, {});
  m_kicks.assign(1, {});
  m_magnets.clear();
  for (const std::int32_t id : m_active) begin(id);
  std::erase_if(m_active, [&](int id) { return m_bodies[at(id)].is_frozen; });
  updatePairs();
  updateContacts();
  m_joints.begin(m_bodies, m_h);
  chooseColours();
  fillRows();
  float time = 0;
  m_turns.assign(m_states.size(), 0);
  m_joints.place(m_states, time);
  for (int i = 0; i < m_options.substeps; ++i) {
    pushByMagnets();
    for (std::size_t state = 1; state < m_states.size(); ++state) {
      SubstepState& s = m_states[state];
      const SubstepKick& kick = m_kicks[state];
      s.vx += kick.x, s.vy += kick.y, s.spin += kick.spin;
    }
    m_joints.warmStart(m_states);
    m_rows.warmStart(m_states);
    m_joints.solve(m_states, true);
    m_rows.solve(m_states, m_h, time, true);
    undoMagnetWork();
    moveStates();
    time += m_h;
    m_joints.place(m_states, time);
    m_joints.solve(m_states, false);
    m_rows.solve(m_states, m_h, time, false);
  }
  m_rows.bounce(m_states);
  for (const std::int32_t id : m_active) m_bodies[at(id)].turn = m_turns[at(m_bodies[at(id)].state)];
  finish();
}

RigidStatus SubstepWorld::step(double dt) {
  if (!(dt > 0 && dt < 1e6)) return RigidStatus::kRefused;
  const std::int64_t frozen_before = m_counters.quarantined;
  m_earlier_events.clear();
  const double parts = std::max(std::floor(dt), 1.0);
  for (double done = 0; done < parts; ++done) {
    stepOnce();
    if (parts == 1) break;
    for (RigidEvent& event : m_events) event.time += done;
    m_earlier_events.insert(m_earlier_events.end(), m_events.begin(), m_events.end());
  }
  if (parts > 1) m_events.swap(m_earlier_events);
  return m_counters.quarantined == frozen_before ? RigidStatus::kDone : RigidStatus::kQuarantined;
}

Vec2 SubstepWorld::movedBy(const SubstepBody& b) const {
  if (b.state == 0) return {};
  const SubstepState& s = m_states[at(b.state)];
  return b.body.velocity + Vec2{s.x, s.y};
}

bool SubstepWorld::isFast(const SubstepBody& b) const {
  const double movement = length(movedBy(b)) + rollOf(b);
  return movement > b.margin + kMaxPass * b.thickness && movement < kFarthest;
}

void SubstepWorld::stopFast() {
  m_fast.clear();
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy >= 0 && isFast(b)) m_fast.push_back({movedBy(b), rollOf(b), b.thickness, id});
  }
  if (m_fast.empty()) return;
  m_paths.clear();
  m_path_ids.clear();
  m_fastness.assign(m_bodies.size(), Fastness::kSlow);
  const Place& origin = m_bodies[at(m_fast[0].id)].body.place;
  for (const Fast& fast : m_fast) {  // so that they find one another
    m_fastness[at(fast.id)] = Fastness::kFast;
    m_path_ids.push_back(static_cast<int>(m_paths.size()));
    m_paths.push_back(relativeTo(origin, sweptBounds(m_bodies[at(fast.id)])));
  }
  m_path_tree.update(m_paths, m_path_ids, static_cast<int>(m_paths.size()));
  for (std::size_t i = 0; i < m_fast.size(); ++i) {
    if (isMovable(m_bodies[at(m_fast[i].id)])) stop(m_fast[i], m_paths[i]);
  }
}

GridBounds SubstepWorld::sweptBounds(const SubstepBody& b) const {
  const Vec2 path = movedBy(b);
  return gridBounds(b.body.place,
                    {{std::min(path.x, 0.0) - b.reach, std::min(path.y, 0.0) - b.reach},
                     {std::max(path.x, 0.0) + b.reach, std::max(path.y, 0.0) + b.reach}},
                    0);
}

// Do they lie in one another, as bodies of a crowd do? They pass until there is room.
bool SubstepWorld::areDeep(const SubstepBody& a, const SubstepBody& b) const {
  const double near = a.thickness + b.thickness;
  return isMovable(a) && isMovable(b) && lengthSquared(b.body.place - a.body.place) < near * near;
}

// What may be in its way. Of fast bodies that fly together none is.
void SubstepWorld::findNear(const Fast& fast, const SweptBox& swept) {
  m_near.clear();
  m_broad.query(sweptBounds(m_bodies[at(fast.id)]), [&](std::uint32_t other) {
    if (m_fastness[other] == Fastness::kSlow) m_near.push_back(static_cast<std::int32_t>(other));
  });
  m_path_tree.query(swept, [&](int number) {
    const Fast& other = m_fast[at(number)];
    if (other.id == fast.id) return;
    const Vec2 its = m_fastness[at(other.id)] == Fastness::kStopped ? Vec2{} : other.path;
    const double nearer = length(fast.path - its) + fast.roll + other.roll;
    if (nearer > kMaxPass * std::min(fast.thickness, other.thickness)) m_near.push_back(other.id);
  });
}

// Two fast ones that meet both stop there.
void SubstepWorld::stop(const Fast& fast, const SweptBox& swept) {
  const std::int32_t id = fast.id;
  SubstepBody& b = m_bodies[at(id)];
  const Vec2 path = fast.path;
  findNear(fast, swept);
  const auto motionOf = [&](const SubstepBody& of) -> RigidMotion {
    if (of.state == 0) return {{}, of.body.rotation, 0};
    if (of.part < 1) return {{}, turned(of.body.rotation, of.part * of.turn), 0};  // where it stops
    return {movedBy(of), of.body.rotation, std::clamp(of.turn, -kMaxTurn, kMaxTurn)};
  };
  const RigidMotion motion = {path, b.body.rotation, std::clamp(b.turn, -kMaxTurn, kMaxTurn)};
  double first = b.part;
  std::int32_t met = -1;
  const std::span<const ConvexShape> own_shapes = m_forms[b.form].shapes;
  const bool is_thinned = m_broad.isThinned(b.proxy);
  for (const std::int32_t near : m_near) {
    const SubstepBody& other = m_bodies[at(near)];
    const RigidMotion its = motionOf(other);
    const double nearer = length(path - its.displacement) + rollOf(b) + rollOf(other);
    if (nearer <= marginOf(b, other) + kMaxPass * std::min(b.thickness, other.thickness)) continue;
    if ((is_thinned || m_broad.isThinned(other.proxy)) && areDeep(b, other)) continue;
    const auto pair = findPair(id, near);
    const bool is_pushing = pair != m_pairs.end() && pair->is_pushing;
    if (pair != m_pairs.end() && pair->is_jointed) continue;
    const Vec2 offset = other.body.place - b.body.place +
                        (other.state > 0 && other.part < 1 ? other.part * movedBy(other) : Vec2{});
    // The rows keep the points apart that they know, yet others may come down in the same tick: what is
    // pushed may turn, but its middle passes nothing.
    ConvexShape core;
    if (is_pushing && makeCircle(kCore * b.thickness, {}, core) != ShapeStatus::kOk) continue;
    for (const ConvexShape& own : is_pushing ? std::span<const ConvexShape>(&core, 1) : own_shapes) {
      for (const ConvexShape& that : m_forms[other.form].shapes) {
        const TimeOfImpact impact = timeOfImpact(own, motion, that, its, offset);
        if (impact.status == TimeOfImpactStatus::kApart || impact.time > first) continue;
        const bool is_later = impact.time == first && (met < 0 || m_bodies[at(met)].order < other.order);
        if (is_later) continue;
        first = impact.time;
        met = near;
      }
    }
  }
  if (first >= b.part) return;
  b.part = first;
  m_fastness[at(id)] = Fastness::kStopped;
  ++m_counters.stopped;
  SubstepBody& other = m_bodies[at(met)];  // what comes the other way stops, too
  if (m_fastness[at(met)] == Fastness::kSlow || !isMovable(other)) return;
  other.part = std::min(other.part, first);
  m_fastness[at(met)] = Fastness::kStopped;
}

// Impulses are floats, which the two bodies of a contact do not feel exactly alike. A group that nothing
// holds gets back what that has taken from its momentum.
void SubstepWorld::keepMomentum() {
  findGroups();
  const auto changeOf = [&](const SubstepBody& b) {
    const SubstepState& s = m_states[at(b.state)];
    const Vec2 gained = b.body.acceleration + b.body.inverse_mass * b.body.force;
    return gained - Vec2{s.vx, s.vy};
  };
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    Group& group = groupOf(b);
    if (group.is_held || !isMovable(b) || b.body.inverse_mass == 0) continue;
    const double mass = 1 / b.body.inverse_mass;
    group.missing += mass * changeOf(b);
    group.mass += mass;
  }
  for (const Magnet& magnet : m_magnets) {  // what turned a body is not missing
    const SubstepBody& b = m_bodies[at(magnet.id)];
    Group& group = groupOf(b);
    if (!group.is_held) group.missing += magnet.given / b.body.inverse_mass;
  }
}

void SubstepWorld::finish() {
  storeContacts();
  stopFast();
  keepMomentum();
  for (const std::int32_t id : m_active) {
    SubstepBody& b = m_bodies[at(id)];
    const SubstepState& s = m_states[at(b.state)];
    const Vec2 moved = b.part * movedBy(b);
    const bool is_sound = isFinite(moved) && isFinite(Vec2{s.vx, s.vy}) && isFinite(Vec2{s.spin, b.turn}) &&
                          std::fabs(moved.x) + std::fabs(moved.y) < 1e12;
    if (!is_sound) {
      freeze(id);
      continue;
    }
    b.body.place = b.body.place + moved;
    if (b.turn != 0) b.body.rotation = turned(b.body.rotation, b.part * b.turn);
    if (!isMovable(b)) continue;
    b.body.velocity += Vec2{s.vx, s.vy};
    const Group& group = groupOf(b);
    if (group.mass > 0 && isFinite(group.missing)) b.body.velocity += group.missing / group.mass;
    b.body.spin += double{s.spin} - double{static_cast<float>(b.body.spin)};
  }
  if (const int broken = m_joints.end(); broken > 0) {
    m_counters.broken += broken;
    m_joints_changed = true;
  }
  sleep();
  std::sort(m_events.begin(), m_events.end(), [](const RigidEvent& x, const RigidEvent& y) {
    if (x.time != y.time) return x.time < y.time;
    if (x.first != y.first) return x.first < y.first;
    return x.second != y.second ? x.second < y.second : x.is_begin < y.is_begin;
  });
}

}  // namespace naiad::physics
