// A step of a SubstepWorld: its sub-steps, and the handling of bodies that move too fast for them.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

constexpr double kFarthest = 1e9;  // metric cells: maximum path in a step, the limit of timeOfImpact()
constexpr double kMaxTurn = 40;    // rad per step: maximum swept rotation; limits timeOfImpact()'s iterations
// Lengths in units of the body's thickness:
constexpr double kSlack = 0.02;       // minimum margin of the search for contacts
constexpr double kSlow = 0.1;         // a body that moves at most this far in a step hardly moves (is_busy)
constexpr double kMaxPass = 0.5;      // limit of movement beyond the search, so the centre passes nothing
constexpr double kCore = 0.5;         // radius of the core that is swept if the other body pushes this one
constexpr std::size_t kFewFast = 4;   // the fast bodies are many if at least one body in this number is fast
constexpr double kBoundsSlack = 0.2;  // margin of bounds in the broad phase; smaller moves do not change them

constexpr double kHeld = 0.05;     // a body is held if less than this part of a magnet's push remains
constexpr double kAhead = 1;       // maximum further margin of the bounds, along the velocity
constexpr double kTicksAhead = 2;  // ticks of movement in the additional margin
constexpr double kNeverKept = kAhead + 2 * kBoundsSlack;  // per tick: a faster body leaves its bounds anyway

// Returns a bound of how far rotation moves a point of the body in this step.
double rollOf(const SubstepBody& b) {
  return b.state == 0 ? 0 : std::min(std::fabs(b.turn), 2.0) * b.reach;
}

Vec2 accelerationOf(const RigidBody& body) {
  return body.inverse_mass > 0 ? body.acceleration : Vec2{};
}
double spinGainOf(const RigidBody& body) {
  return body.inverse_inertia > 0 ? body.inverse_inertia * body.torque : 0;
}

// Returns how far the velocity gained from pushes moves a body and its corners in a step over `dt`.
double pushOn(const SubstepBody& b, const SubstepState& s, double dt) {
  const double spun = double{s.spin} - b.body.spin - dt * spinGainOf(b.body);
  const Vec2 gained = Vec2{s.vx, s.vy} - dt * accelerationOf(b.body);
  return dt * (length(gained) + std::min(std::fabs(spun), 2.0) * b.reach);
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
  std::array<std::uint64_t, 2> last = {};  // `order` of the last movable and the last immovable body
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
  if (m_is_shuffled) sortActive();
}

void SubstepWorld::sortActive() {
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
  b.is_diverted = false;
  if (m_time == 0) b.is_stopped = false;
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
  if (m_broad.isThinned(b.proxy)) {
    m_broad.set(b.proxy, wideBounds(b));  // so that updatePairs() tests again whether it is in a crowd
  } else {
    m_broad.move(b.proxy, gridBounds(body.place, b.box, b.margin), wideBounds(b));
  }
}

// Predicts how far the body moves in this step if nothing pushes it.
void SubstepWorld::forecast(SubstepBody& b) const {
  const double angle = m_dt * (std::fabs(b.body.spin) + m_dt * std::fabs(spinGainOf(b.body)));
  b.drift = m_dt * (b.body.velocity + (0.5 * m_dt) * accelerationOf(b.body));
  b.roll = std::min(angle, 2.0) * b.reach;
  const double movement = length(b.drift) + b.roll;
  b.margin = std::min(movement, b.thickness) + kSlack * b.thickness;
  const bool was_pushed = b.pushed_at + 1 == m_steps;
  if (!was_pushed) b.push = 0;
  b.is_busy = !isMovable(b) || movement <= kSlow * b.thickness || was_pushed;
}

// Returns the gap above which two bodies cannot touch in this step, unless something pushes one of them.
double SubstepWorld::calmMargin(const SubstepBody& a, const SubstepBody& b) {
  return length(b.drift - a.drift) + a.roll + b.roll + kSlack * (a.thickness + b.thickness);
}

// Returns bounds with room for the moves of the next steps. A fast body would leave them anyway, and in a
// crowd wide bounds would overlap those of more other bodies; the bounds of such bodies have no extra room.
GridBounds SubstepWorld::wideBounds(const SubstepBody& b) const {
  const double most = kAhead * b.thickness;
  const double speed = std::max(std::fabs(b.body.velocity.x), std::fabs(b.body.velocity.y));
  const bool is_in_crowd = b.proxy >= 0 && m_broad.isThinned(b.proxy);
  if (is_in_crowd || speed > kNeverKept * b.thickness) return gridBounds(b.body.place, b.box, b.margin);
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
    const Vec2 middle = 0.5 * (right + velocity) - (b.body.velocity - m_energy.velocity(b.state));
    m_energy.giveFromSprings(b.state, m_energy.mass(b.state) * dot(right - velocity, middle));
    s.vx = static_cast<float>(gained.x), s.vy = static_cast<float>(gained.y);
    magnet.given += right - velocity;
  }
}

// Uses half the angle as the tangent of half the angle, so that the rotation has length one for any angle.
void SubstepWorld::moveStates(std::span<const std::int32_t> states) {
  for (const std::int32_t i : states) {
    SubstepState& s = m_states[at(i)];
    s.x += m_h * s.vx, s.y += m_h * s.vy;
    const float angle = m_h * s.spin;
    m_turns[at(i)] += double{angle};
    const float square = 0.25f * angle * angle;
    const float by = 1 / (1 + square);
    const float cosine = (1 - square) * by, sine = angle * by;
    const float c = cosine * s.c - sine * s.s;
    s.s = sine * s.c + cosine * s.s;
    s.c = c;
  }
}

// Sets the masses and groups of the bodies. chooseColours() has found the groups.
void SubstepWorld::beginEnergy() {
  const auto hold = [this](const SubstepBody& b, bool by_immovable) {
    if (by_immovable && b.state > 0) m_energy.hold(b.state);
  };
  m_joints.visitLinks([&](int a, int b) {
    if (a >= 0) hold(m_bodies[at(a)], !isMovable(m_bodies[at(b)]));
    hold(m_bodies[at(b)], a < 0 || !isMovable(m_bodies[at(a)]));
  });
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy >= 0 && m_broad.isThinned(b.proxy)) m_energy.ignore(b.state);
    m_energy.set(b.state, b.body.velocity, b.inverse_mass > 0 ? 1 / double{b.inverse_mass} : 0,
                 b.inverse_inertia > 0 ? 1 / double{b.inverse_inertia} : 0, m_sets.rootOf(b.state));
  }
  m_energy.chooseFrames();
}

// Keeps the impulses of this sub-step from adding energy.
void SubstepWorld::balance(std::span<const std::int32_t> states) {
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, work); });
  m_joints.visitWork([this](int state, double work) { m_energy.giveFromSprings(state, work); });
  if (!m_energy.balance(states, m_states, false)) return;
  m_rows.scale(m_energy.factors());
  m_joints.scale(m_energy.factors(), m_states);
}

void SubstepWorld::bounce(std::span<const std::int32_t> states) {
  if (!m_rows.mayBounce()) return;
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, -work); });
  for (const std::int32_t state : states) {
    Lanes speeds;
    __builtin_memcpy(&speeds, &m_states[at(state)].vx, sizeof speeds);
    m_energy.note(state, speeds);
  }
  m_rows.bounce(m_states);
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, work); });
  m_energy.balance(states, m_states, true);
}

void SubstepWorld::stepBatch(std::span<const std::int32_t> states) {
  float time = 0;
  m_energy.beginBatch(states);
  for (int i = 0; i < m_options.substeps; ++i) {
    pushByMagnets();
    for (const std::int32_t state : states) {
      SubstepState& s = m_states[at(state)];
      Lanes speeds, kick;
      __builtin_memcpy(&speeds, &s.vx, sizeof speeds);
      __builtin_memcpy(&kick, &m_kicks[at(state)], sizeof kick);
      speeds += kick;
      __builtin_memcpy(&s.vx, &speeds, sizeof speeds);
      m_energy.note(state, speeds);
    }
    m_joints.warmStart(m_states);
    m_rows.warmStart(m_states);
    m_joints.solveSoftly(m_states);
    m_rows.solve(m_states, m_h, time, true);
    undoMagnetWork();
    moveStates(states);
    time += m_h;
    m_joints.relax(m_states, time);
    m_rows.solve(m_states, m_h, time, false);
    balance(states);
  }
  bounce(states);
}

void SubstepWorld::step() {
  m_events.clear();
  ++m_counters.ticks;
  m_h = 1 / static_cast<float>(m_options.searches * m_options.substeps);
  for (int i = 0; i < m_options.searches; ++i) {
    m_time = i * m_dt;
    stepOnce();
  }
  sortEvents();
}

void SubstepWorld::stepOnce() {
  ++m_steps;
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
  chooseBatches();
  beginEnergy();
  m_turns.assign(m_states.size(), 0);
  std::span<const std::int32_t> states = m_by_batch, contacts = m_by_colour;
  for (const Batch& batch : m_batches) {
    const auto of_batch = contacts.first(batch.contacts);
    m_rows.clear(batch.blocks, m_h);
    fillRows(of_batch);
    stepBatch(states.first(batch.states));
    storeImpulses(of_batch);
    contacts = contacts.subspan(batch.contacts);
    states = states.subspan(batch.states);
  }
  m_counters.scaled = m_energy.scaled();
  for (const std::int32_t id : m_active) m_bodies[at(id)].turn = m_turns[at(m_bodies[at(id)].state)];
  finish();
}

Vec2 SubstepWorld::movedBy(const SubstepBody& b) const {
  if (b.state == 0) return {};
  const SubstepState& s = m_states[at(b.state)];
  return m_dt * b.body.velocity + Vec2{s.x, s.y};
}

bool SubstepWorld::isFast(const SubstepBody& b) const {
  const double movement = length(movedBy(b)) + rollOf(b);
  return movement > b.margin + kMaxPass * b.thickness && movement < kFarthest;
}

void SubstepWorld::stopFast() {
  m_fast.clear();
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy < 0 || !isFast(b)) continue;
    m_fast.push_back({movedBy(b), rollOf(b), b.thickness, id, sweptBounds(b, movedBy(b))});
  }
  if (m_fast.empty()) return;
  treePaths();
  m_near.clear();
  if (m_are_crowded) {
    for (const Fast& fast : m_fast) {
      const int own = m_fast_numbers[at(fast.id)];
      visitPathsBeside(own, [&](int other) {
        if (other > own) approach(own, other);
      });
    }
  } else {
    m_path_tree.queryPairs([this](int one, int other) { approach(one, other); });
  }
  for (Fast& fast : m_fast) {
    if (!isMovable(m_bodies[at(fast.id)])) continue;
    if (!m_are_many) {
      m_broad.query(fast.way, [&](std::uint32_t other) {
        if (m_fast_numbers[other] == kSlowNumber) addNear(fast, static_cast<std::int32_t>(other));
      });
    }
    stop(fast);
  }
}

// Builds the tree of paths in which fast bodies find each other and, if there are many fast ones, the slow
// bodies. Paths are relative to a frame that moves with the fast bodies (m_along), in which they are short.
void SubstepWorld::treePaths() {
  m_paths.clear();
  m_path_values.clear();
  m_path_ids.clear();
  m_slow.clear();
  m_fast_numbers.assign(m_bodies.size(), kSlowNumber);
  m_along = middlePath();
  for (const Fast& fast : m_fast) {
    m_fast_numbers[at(fast.id)] = static_cast<std::int32_t>(m_paths.size());
    m_paths.push_back(seenPath(fast));
    m_path_values.push_back(crowdValue(m_bodies[at(fast.id)]));
  }
  const Place& origin = m_bodies[at(m_fast[0].id)].body.place;
  m_are_crowded = std::find(m_path_values.begin(), m_path_values.end(), kInCrowd) != m_path_values.end();
  m_are_many = m_are_crowded || m_fast.size() * kFewFast >= m_bodies.size();
  for (std::int32_t id = 0; m_are_many && id < idLimit(); ++id) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy < 0 || m_fast_numbers[at(id)] != kSlowNumber) continue;
    m_slow.push_back({m_broad.bounds(b.proxy), id});
    SweptBox swept = relativeTo(origin, m_broad.bounds(b.proxy));
    const Vec2 back = double{-kGridUnits} * m_along;
    swept.low += {std::min(back.x, 0.0), std::min(back.y, 0.0)};
    swept.high += {std::max(back.x, 0.0), std::max(back.y, 0.0)};
    m_paths.push_back(swept);
    m_path_values.push_back(crowdValue(b));
  }
  for (std::size_t i = 0; i < m_paths.size(); ++i) m_path_ids.push_back(static_cast<int>(i));
  m_path_tree.update(m_paths, m_path_ids, static_cast<int>(m_paths.size()), m_path_values);
}

// Calls visit() for the paths that overlap a path. Skips pairs of bodies in crowds, which pass each other.
template <typename Visit>
void SubstepWorld::visitPathsBeside(int own, Visit&& visit) const {
  const SweptBox& box = m_path_tree.box(own);
  const bool is_in_crowd = m_path_values[at(own)] == kInCrowd;
  m_path_tree.walk(
      [&](const ImpactTree::Below& below) {
        return overlaps(below.box, box) && !(is_in_crowd && below.least == kInCrowd);
      },
      visit);
}

SweptBox SubstepWorld::seenPath(const Fast& fast) const {
  const Place& origin = m_bodies[at(m_fast[0].id)].body.place;
  return relativeTo(origin, sweptBounds(m_bodies[at(fast.id)], fast.path - m_along));
}

// Returns the median of the fast bodies' paths, which a single very fast body does not change much.
Vec2 SubstepWorld::middlePath() {
  m_path_order.resize(m_fast.size());
  const auto middle = m_path_order.begin() + static_cast<std::ptrdiff_t>(m_fast.size() / 2);
  const auto middleOf = [&](double Vec2::*axis) {
    for (std::size_t i = 0; i < m_fast.size(); ++i) m_path_order[i] = m_fast[i].path.*axis;
    std::nth_element(m_path_order.begin(), middle, m_path_order.end());
    return *middle;
  };
  return {middleOf(&Vec2::x), middleOf(&Vec2::y)};
}

GridBounds SubstepWorld::sweptBounds(const SubstepBody& b, Vec2 path) {
  return gridBounds(b.body.place,
                    {{std::min(path.x, 0.0) - b.reach, std::min(path.y, 0.0) - b.reach},
                     {std::max(path.x, 0.0) + b.reach, std::max(path.y, 0.0) + b.reach}},
                    0);
}

float SubstepWorld::crowdValue(const SubstepBody& b) const {
  return isMovable(b) && m_broad.isThinned(b.proxy) ? kInCrowd : 0;
}

// True if the bodies may pass through each other: both are in crowds, or one is and their centres are near.
bool SubstepWorld::passes(const SubstepBody& a, const SubstepBody& b) const {
  if (!isMovable(a) || !isMovable(b)) return false;
  const bool is_thinned = m_broad.isThinned(a.proxy), is_other = m_broad.isThinned(b.proxy);
  if (!is_thinned && !is_other) return false;
  const double near = a.thickness + b.thickness;
  return (is_thinned && is_other) || lengthSquared(b.body.place - a.body.place) < near * near;
}

void SubstepWorld::addNear(Fast& fast, std::int32_t id) {
  if (passes(m_bodies[at(fast.id)], m_bodies[at(id)])) return;
  ++m_counters.near;
  m_near.push_back({id, std::exchange(fast.near, static_cast<std::int32_t>(m_near.size()))});
}

// Adds each of two bodies of the path tree, one < other, to the possible obstacles of the other one if that
// is fast. Skips fast bodies that fly together until one of them is stopped or diverted.
void SubstepWorld::approach(int one, int other) {
  const auto fast_ones = static_cast<int>(m_fast.size());
  if (one >= fast_ones) return;
  Fast& fast = m_fast[at(one)];
  if (other >= fast_ones) {
    const Slow& slow = m_slow[at(other - fast_ones)];
    if (overlap(slow.bounds, fast.way)) addNear(fast, slow.id);
    return;
  }
  Fast& that = m_fast[at(other)];
  const double nearer = length(fast.path - that.path) + fast.roll + that.roll;
  const bool are_together = nearer <= kMaxPass * std::min(fast.thickness, that.thickness);
  if (are_together && !fast.is_stopped && !that.is_stopped) return;
  addNear(fast, that.id);
  addNear(that, fast.id);
}

// Repeats approach() for a body that was stopped or diverted.
void SubstepWorld::approachAgain(Fast& fast) {
  const int own = m_fast_numbers[at(fast.id)];
  visitPathsBeside(own, [&](int other) {
    if (other != own) approach(std::min(own, other), std::max(own, other));
  });
}

// True if no immovable body touches the body, neither now nor on this path.
bool SubstepWorld::isClear(const SubstepBody& b, Vec2 path) {
  bool is_clear = true;
  const RigidMotion motion = {path, b.body.rotation, std::clamp(b.turn, -kMaxTurn, kMaxTurn)};
  m_broad.query(sweptBounds(b, path), [&](std::uint32_t id) {
    const SubstepBody& other = m_bodies[id];
    if (!is_clear || isMovable(other)) return;
    const RigidMotion its = motionOf(other);
    for (const ConvexShape& own : m_forms[b.form].shapes) {
      for (const ConvexShape& that : m_forms[other.form].shapes) {
        const TimeOfImpact impact = timeOfImpact(own, motion, that, its, other.body.place - b.body.place);
        is_clear = is_clear && impact.status == TimeOfImpactStatus::kApart && !impact.touched_before;
      }
    }
  });
  return is_clear;
}

// Returns the body's motion in this step. If the body was stopped, returns no motion, at its final rotation.
RigidMotion SubstepWorld::motionOf(const SubstepBody& b) const {
  if (b.state == 0) return {{}, b.body.rotation, 0};
  if (b.part < 1) return {{}, turned(b.body.rotation, b.part * b.turn), 0};
  return {movedBy(b), b.body.rotation, std::clamp(b.turn, -kMaxTurn, kMaxTurn)};
}

// Stops a fast body where it first touches a possible obstacle, or moves both on a common path from there.
void SubstepWorld::stop(Fast& fast) {
  const std::int32_t id = fast.id;
  SubstepBody& b = m_bodies[at(id)];
  const Vec2 path = fast.path;
  const RigidMotion motion = {path, b.body.rotation, std::clamp(b.turn, -kMaxTurn, kMaxTurn)};
  double first = b.part;
  std::int32_t met = -1;
  const std::span<const ConvexShape> own_shapes = m_forms[b.form].shapes;
  for (std::int32_t i = fast.near; i >= 0; i = m_near[at(i)].next) {
    const std::int32_t near = m_near[at(i)].id;
    const SubstepBody& other = m_bodies[at(near)];
    const RigidMotion its = motionOf(other);
    const double nearer = length(path - its.displacement) + rollOf(b) + rollOf(other);
    const double pass = kMaxPass * std::min(b.thickness, other.thickness);
    if (nearer <= marginOf(b, other) + pass) continue;
    const auto pair = findPair(id, near);
    if (pair != m_pairs.end() && pair->is_jointed) continue;
    const bool is_pushing = pair != m_pairs.end() && pair->is_pushing;
    if (is_pushing && nearer <= b.margin + other.margin + pass) continue;
    const Vec2 offset = other.body.place - b.body.place +
                        (other.state > 0 && other.part < 1 ? other.part * movedBy(other) : Vec2{});
    // Rows keep only the known points apart, and other corners may touch in this step. So a body that is
    // pushed may rotate into the other body, but its core must not pass the other one. A body that is already
    // inside an immovable one would leave it on the far side, without touching more of it.
    ConvexShape core;
    const bool has_core =
        (is_pushing || !isMovable(other)) && makeCircle(kCore * b.thickness, {}, core) == ShapeStatus::kOk;
    const auto sweep = [&](const ConvexShape& own) {
      for (const ConvexShape& that : m_forms[other.form].shapes) {
        const TimeOfImpact impact = timeOfImpact(own, motion, that, its, offset);
        if (impact.status == TimeOfImpactStatus::kApart || impact.time > first) continue;
        const bool is_later = impact.time == first && (met < 0 || m_bodies[at(met)].order < other.order);
        if (is_later) continue;
        first = impact.time;
        met = near;
      }
    };
    if (has_core) sweep(core);
    if (is_pushing) continue;
    for (const ConvexShape& own : own_shapes) sweep(own);
  }
  if (first >= b.part) return;
  ++m_counters.stopped;
  const std::int32_t number = m_fast_numbers[at(met)];
  Fast* const p_met = number == kSlowNumber || !isMovable(m_bodies[at(met)]) ? nullptr : &m_fast[at(number)];
  if (p_met != nullptr && !p_met->is_stopped && advanceTogether(fast, *p_met, first)) return;
  for (Fast* const p_fast : {&fast, p_met}) {  // the fast body that was hit stops, too
    if (p_fast == nullptr) continue;
    double& part = m_bodies[at(p_fast->id)].part;
    part = std::min(part, first);
    p_fast->is_stopped = true;
    approachAgain(*p_fast);
  }
}

// Gives two fast bodies that meet at `time` a common path from there on. If they stopped, bodies that fly
// behind them would run into them. Returns false, without a change, if an immovable body is in the way.
bool SubstepWorld::advanceTogether(Fast& one, Fast& other, double time) {
  // Only the ratio of the masses matters, so the inverse masses are exchanged.
  const double mass_of_other = m_bodies[at(one.id)].body.inverse_mass;
  const double mass_of_one = m_bodies[at(other.id)].body.inverse_mass;
  const double sum = mass_of_one + mass_of_other;
  if (!(sum > 0)) return false;
  const Vec2 common = (mass_of_one * one.path + mass_of_other * other.path) / sum;
  const auto pathOf = [&](const Fast& fast) { return time * fast.path + (1 - time) * common; };
  for (const Fast* const p_fast : {&one, &other}) {
    if (!isClear(m_bodies[at(p_fast->id)], pathOf(*p_fast))) return false;
  }
  for (Fast* const p_fast : {&one, &other}) {
    SubstepBody& b = m_bodies[at(p_fast->id)];
    const Vec2 gained = pathOf(*p_fast) - m_dt * b.body.velocity;
    SubstepState& s = m_states[at(b.state)];
    s.x = static_cast<float>(gained.x), s.y = static_cast<float>(gained.y);
    p_fast->path = movedBy(b);
    p_fast->way = sweptBounds(b, p_fast->path);
    b.is_diverted = true;
    m_path_tree.grow(m_fast_numbers[at(p_fast->id)], seenPath(*p_fast));
  }
  approachAgain(one);
  approachAgain(other);
  return true;
}

void SubstepWorld::finish() {
  reportContacts();
  stopFast();
  keepMomentum();
  for (const std::int32_t id : m_active) {
    SubstepBody& b = m_bodies[at(id)];
    b.is_shaken = false;
    b.is_stopped = b.is_stopped || b.part < 1 || b.is_diverted;
    const SubstepState& s = m_states[at(b.state)];
    const Group& group = groupOf(b);
    const bool falls = group.mass > 0 && !group.is_diverted && isMovable(b);
    const Vec2 moved = b.part * movedBy(b) + (falls ? group.missing_path / group.mass : Vec2{});
    const bool is_sound = isFinite(moved) && isFinite(Vec2{s.vx, s.vy}) && isFinite(Vec2{s.spin, b.turn}) &&
                          std::fabs(moved.x) + std::fabs(moved.y) < 1e12;
    if (!is_sound) {
      freeze(id);
      continue;
    }
    b.body.place = b.body.place + moved;
    if (b.turn != 0) b.body.rotation = turned(b.body.rotation, b.part * b.turn);
    if (!isMovable(b)) continue;
    b.push = pushOn(b, s, m_dt);
    b.body.velocity += Vec2{s.vx, s.vy};
    if (group.mass > 0 && isFinite(group.missing)) b.body.velocity += group.missing / group.mass;
    b.body.spin += double{s.spin} - double{static_cast<float>(b.body.spin)};
  }
  keepAngularMomentum();
  if (const int broken = m_joints.end(m_dt); broken > 0) {
    m_counters.broken += broken;
    m_joints_changed = true;
  }
  sleep();
}

}  // namespace naiad::physics
