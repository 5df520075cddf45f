// A step of a SubstepWorld and its sub-steps.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

// Lengths in units of the body's thickness:
constexpr double kSlack = 0.02;       // minimum margin of the search for contacts
constexpr double kSlow = 0.1;         // a body that moves at most this far in a step hardly moves (is_busy)
constexpr double kBoundsSlack = 0.2;  // margin of bounds in the broad phase; smaller moves do not change them

constexpr double kHeld = 0.05;     // a body is held if less than this part of a magnet's push remains
constexpr double kAhead = 1;       // maximum further margin of the bounds, along the velocity
constexpr double kTicksAhead = 2;  // ticks of movement in the additional margin
constexpr double kNeverKept = kAhead + 2 * kBoundsSlack;  // per tick: a faster body leaves its bounds anyway

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

}  // namespace

void SubstepWorld::listActive() {
  if (!m_active_changed) return;
  m_active_changed = false;
  m_active.clear();
  m_drivers.clear();
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
    const bool is_driver = !isMovable(b) && (b.body.velocity != Vec2{} || b.body.spin != 0);
    if (is_driver) m_drivers.push_back(id);
    if (is_driver || isMovable(b)) m_active.push_back(id);
  }
  if (m_is_shuffled) sortActive();
}

// Sorts the active bodies from m_active[first] on by their order.
void SubstepWorld::sortActive(std::size_t first) {
  std::sort(m_active.begin() + static_cast<std::ptrdiff_t>(first), m_active.end(),
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

// Sets the masses and groups of the bodies that impulses may push. chooseColours() has found the groups.
void SubstepWorld::beginEnergy() {
  const auto watch = [this](const SubstepBody& b, bool is_held) {
    m_energy.join(b.state);
    if (is_held) m_energy.hold(b.state);
  };
  m_joints.visitLinks([&](int a, int b) {
    if (a >= 0) watch(m_bodies[at(a)], !isMovable(m_bodies[at(b)]));
    watch(m_bodies[at(b)], a < 0 || !isMovable(m_bodies[at(a)]));
  });
  for (const Magnet& magnet : m_magnets) m_energy.hold(m_bodies[at(magnet.id)].state);
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    if (!m_energy.isWatched(b.state)) continue;
    if (b.proxy >= 0 && m_broad.isThinned(b.proxy)) m_energy.ignore(b.state);
    m_energy.set(b.state, b.body, b.inverse_mass > 0 ? 1 / double{b.inverse_mass} : 0,
                 b.inverse_inertia > 0 ? 1 / double{b.inverse_inertia} : 0, m_sets.rootOf(b.state));
  }
}

// Keeps the impulses of this sub-step from adding energy.
void SubstepWorld::balance(double time) {
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, work); });
  m_joints.visitWork([this](int state, double work) { m_energy.giveFromSprings(state, work); });
  if (!m_energy.balance(m_states, time, false)) return;
  m_rows.scale(m_energy.factors());
  m_joints.scale(m_energy.factors(), m_states, m_rows);
}

void SubstepWorld::bounce(double time) {
  if (!m_rows.mayBounce()) return;
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, -work); });
  m_energy.note(m_states);
  m_rows.bounce(m_states);
  m_joints.bounce(m_states, m_rows);
  m_rows.visitWork([this](int state, double work) { m_energy.giveByImpulses(state, work); });
  m_energy.balance(m_states, time, true);
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
    m_joints.solveSoftly(m_states, m_rows);
    m_rows.solve(m_states, m_h, time, true);
    undoMagnetWork();
    moveStates(states);
    time += m_h;
    m_joints.relax(m_states, m_rows, time);
    m_rows.solve(m_states, m_h, time, false);
    balance(double{time});
  }
  bounce(double{time});
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
  if (!m_drivers.empty()) wakeAhead();
  std::erase_if(m_active, [&](int id) { return m_bodies[at(id)].is_frozen; });
  updatePairs();
  updateContacts();
  m_joints.begin(m_bodies, m_h);
  if (!m_joints.isEmpty()) giveLoads();
  m_joints.makeRows(m_bodies);
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
