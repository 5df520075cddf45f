#include "physics/body/BodyLayer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyEvents.h"
#include "physics/body/BodyFlight.h"
#include "physics/body/BodyLimits.h"
#include "physics/geometry/Reserve.h"

namespace naiad::physics {

namespace {

constexpr double kFarthestFlight =
    1e12;                         // metric cells in a tick; less than 2^51, the limit for moving a Place
constexpr double kFollowed = 16;  // per tick²: maximum stiffness of a spring that swings little in a tick
constexpr const char* kBeyond = "its position or velocity is out of range";

}  // namespace

BodyLayer& BodyLayer::of(World& world) {
  if (auto* p_layer = world.findLayer<BodyLayer>()) return *p_layer;
  world.addLayer(std::make_unique<BodyLayer>());
  return *world.findLayer<BodyLayer>();
}

void placeMoved(World& world, const std::vector<MovedObject>& all) {
  for (const MovedObject& moved : all) {
    if (takesPart(world.store(), moved.key)) world.mover().place(moved.key, moved.where);
  }
}

// Steps all bodies from their states at the start of the tick, then publishes positions and runs handlers.
void BodyLayer::step(World& world) {
  m_moved.clear();
  m_states.clear();
  m_unit_inertias.clear();
  m_contacts.beginTick();
  m_is_mixed = m_has_joined = false;
  m_kinematic = 0;
  m_links.prepare(*m_table);
  m_impacts.beginTick();
  reserveFor(m_states, m_table->inOrder().size());
  m_evaluations_before = m_table->counters.integrator.evaluations;
  for (const BodyTable::Index index : m_table->inOrder()) beginBody(world, index);
  ++m_table->ticks;
  chooseSolvers(world.store());
  if (!m_impacts.isEmpty()) {
    m_impacts.step(world, *m_table, m_states, m_contacts);
    if (m_impacts.hasGivenUp()) passOnGivenUp();
    m_impacts.finish(world.store(), *m_table, m_states, m_contacts);
  }
  if (m_kinematic > 1 || !m_platforms.isEmpty()) m_platforms.find(world.store(), *m_table, m_states);
  if (m_is_mixed || m_has_joined || !m_rigids.isEmpty()) {
    m_rigids.step(world.store(), *m_table, m_platforms, m_states, m_unit_inertias, m_contacts);
  }
  if (m_has_substeps || !m_substeps.isEmpty())
    m_substeps.step(world.store(), *m_table, m_platforms, m_states, m_unit_inertias, m_contacts);
  if (m_islands.hasHeaps() || !m_heaps.isEmpty())
    m_heaps.step(world.store(), *m_table, m_platforms, m_states, m_unit_inertias, m_contacts);
  logCrowd(world);
  logScaling(world);
  logSunk(world);
  for (State& state : m_states) settle(world, state);
  placeMoved(world, m_moved);
  m_sensors.step(world.store(), *m_table, m_states, m_contacts);
  send(world, m_contacts.finishTick());
  endMarked(world);
}

void BodyLayer::send(World& world, std::vector<BodyContact>& contacts) {
  if (!contacts.empty() && sendContactEvents(world, contacts)) m_contacts.noteMissed(contacts);
}

// The handlers may mark more Objects.
void BodyLayer::endMarked(World& world) {
  const std::vector<ObjectKey>& marked = world.objects().marked();
  for (std::size_t known = 0; known < marked.size() && !m_contacts.isEmpty();) {
    known = marked.size();
    send(world, m_contacts.endMarked(world.store()));
  }
}

void BodyLayer::beginBody(World& world, BodyTable::Index index) {
  BodyRow& row = m_table->row(index);
  const WorldStore& store = world.store();
  if (!store.isCurrent(row.key)) {  // removed, and perhaps inserted again
    m_contacts.expire(row.key);
    row.key = row.p_object->key();
  }
  if (!takesPart(store, row.key)) return;
  m_table->syncFromStore(index, store.position(row.key.slot), store.velocity(row.key.slot));
  if (row.frozen) return;
  const BodyGeometry& form = std::as_const(*m_table).form(index);
  State& state = m_states.emplace_back();
  state.index = index;
  state.key = row.key;
  state.order = store.order(row.key.slot);
  state.is_hard = store.solidness(row.key.slot) == HARD;
  state.is_soft = store.solidness(row.key.slot) == SOFT;
  state.is_kinematic = row.is_kinematic;
  state.has_joints = m_links.isJoined(index);
  state.is_joined = state.has_joints && !row.is_kinematic;
  state.is_near_rigid = row.is_kinematic && !m_table->settings.is_fast && state.has_joints;
  if (state.is_kinematic && state.is_hard) ++m_kinematic;
  state.start = row.place;
  state.start_velocity = row.velocity;
  state.rotation = form.rotation;
  state.spin = form.spin;
  if (!row.is_kinematic) {
    state.push = row.gravity_scale * m_table->settings.gravity + row.inverse_mass * row.force;
    state.acceleration = row.gravity_scale * m_table->settings.gravity;
    const Vec2 most = 2 * m_table->metric.fromCells(Vector(kMaxVelocityCells, kMaxVelocityCells));
    const Vec2 push = {std::clamp(state.push.x, -most.x, most.x), std::clamp(state.push.y, -most.y, most.y)};
    if (push != state.push && state.is_joined) {
      state.p_failure = "the force on it is too large for joints";
    } else if (push != state.push) {
      countLimited(world, state);
    }
    state.push = push;
  }
  row.force = {};
  const bool turns = form.is_turning && !row.is_kinematic;
  m_unit_inertias.push_back(turns ? m_table->unitInertia(index, store.box(row.key.slot)) : 0);
  fly(state);
  state.is_in_heap = m_rigids.isGivenUp(*m_table, index);
  state.is_costly = state.is_joined && m_links.isCostly(index);
  m_is_mixed = m_is_mixed || state.is_in_heap || state.is_costly;
  if (state.is_joined && state.p_failure == nullptr) {
    state.solver = BodySolver::kRigid;
    m_has_joined = true;
    // A force that is not constant is replaced by its mean over the tick.
    if (state.is_bent && !state.is_sprung && state.turn_rate == 0)
      state.push = state.flown.velocity - row.velocity;
  }
  if (state.is_hard && state.p_failure == nullptr) measure(store, state);
}

// Sets turn_rate if a magnet acts on a body that may be held. Returns the push without that of the magnet.
Vec2 BodyLayer::pushBesideMagnet(State& state) {
  const BodyRow& row = m_table->row(state.index);
  const bool may_be_held = !row.is_kinematic && !state.is_sprung && (state.is_hard || state.is_joined);
  Magnet magnet;
  const BodyMedium& medium = std::as_const(*m_table).medium(state.index);
  if (!may_be_held || !magnetOf(row, medium, state.push, static_cast<double>(m_table->ticks), magnet))
    return state.push;
  state.turn_rate = magnet.rate;
  return magnet.rest;
}

// Computes the flight of a body by itself. The evaluations of fields are limited: each body has some, and all
// bodies share more, oldest bodies first. When these are used up, a body gets only a few implicit steps.
IntegratorStatus BodyLayer::flyFreely(const State& state, Flown& flown) {
  constexpr std::int64_t kSharedEvaluations = 8000,
                         kOwnEvaluations = 200;  // limits; smooth fields need fewer
  constexpr int kFewSteps = 16;
  const BodyRow& row = m_table->row(state.index);
  const BodyMedium& medium = std::as_const(*m_table).medium(state.index);
  const auto time = static_cast<double>(m_table->ticks);
  IntegratorCounters& counters = m_table->counters.integrator;
  IntegratorOptions options = m_table->settings.integrator;
  const auto own = kOwnEvaluations * static_cast<std::int64_t>(m_states.size());
  const bool is_spent = options.method == IntegratorMethod::kAutomatic &&
                        counters.evaluations - m_evaluations_before > kSharedEvaluations + own;
  if (is_spent) options.max_evaluations = 1, options.max_steps = std::min(options.max_steps, kFewSteps);
  return flyBody(row, medium, state.push, time, 1, options, flown, counters);
}

// Computes where the body would move if nothing touched it.
void BodyLayer::fly(State& state) {
  const BodyRow& row = m_table->row(state.index);
  const BodyMedium& medium = std::as_const(*m_table).medium(state.index);
  const auto time = static_cast<double>(m_table->ticks);
  IntegratorStatus status = IntegratorStatus::kDone;
  const JointEntry* p_spring = row.is_kinematic ? nullptr : m_links.hangsOn(*m_table, state.index);
  state.is_bent = !row.is_kinematic && (p_spring != nullptr || row.flight != FlightKind::kFree);
  if (state.is_bent && p_spring == nullptr) {
    state.is_sprung = pullOf(row, medium, state.push, time, state.pull);
  } else if (p_spring != nullptr &&
             (row.flight == FlightKind::kFree || row.flight == FlightKind::kLinearDrag)) {
    state.is_sprung = true;  // by its spring joint
    state.pull.spring.damping = medium.linear_drag;
  }
  const Vec2 held_push = pushBesideMagnet(state);
  state.must_be_held = (state.turn_rate != 0 && (state.is_joined || m_contacts.isTouching(state.key))) ||
                       (state.is_sprung && state.is_joined);
  if (!state.is_bent || state.must_be_held) {
    state.flown = flyFree(row.velocity, held_push, 1);
  } else if (p_spring != nullptr) {
    status = flyHanging(row, medium, p_spring->joint, p_spring->anchor, state.push, time,
                        m_table->settings.integrator, state.flown, m_table->counters.integrator);
  } else {
    status = flyFreely(state, state.flown);
  }
  if (status != IntegratorStatus::kDone && state.is_sprung) {  // then the solver needs no flight
    state.must_be_held = true;
    state.flown = flyFree(row.velocity, state.push, 1);
    status = IntegratorStatus::kDone;
  }
  state.push = held_push;
  m_is_mixed = m_is_mixed || state.must_be_held;
  if (status != IntegratorStatus::kDone) state.p_failure = "its free motion cannot be computed";
  const bool is_near = isFinite(state.flown.velocity) &&
                       lengthSquared(state.flown.displacement) < kFarthestFlight * kFarthestFlight;
  if (state.p_failure == nullptr && !is_near) state.p_failure = kBeyond;
  if (state.p_failure != nullptr) return;
  if (state.is_bent) state.acceleration = state.flown.velocity - row.velocity;
  state.place = row.place + state.flown.displacement;
  state.velocity = state.flown.velocity;
}

// Returns the maximum movement caused by a pull, which is a swing to the other side of its target.
Vec2 BodyLayer::swingOf(const State& state) const {
  if (!state.isPulled()) return {};
  const Vec2 away = state.start - state.pull.to;
  return {2 * std::abs(away.x), 2 * std::abs(away.y)};
}

// Finds whether an ImpactWorld can move the body, and how far the body can move in this tick.
void BodyLayer::measure(const WorldStore& store, State& state) {
  constexpr double kRoom = 0.25;  // metric cells: margin around the area that the body reaches by itself
  const BodyGeometry& form = std::as_const(*m_table).form(state.index);
  const FixedBox box = store.box(state.key.slot);
  Vec2 offset;
  if (!m_table->settings.is_fast) {
    ImpactBody body;
    state.is_simple = BodyImpacts::canHave(form, m_table->metric, box, body, offset) &&
                      !m_table->row(state.index).touches_soft && !state.is_sprung && state.turn_rate == 0;
    const bool was_general =
        naiad::physics::isSoft(static_cast<BodySolver>(m_table->row(state.index).last_solver));
    if (!state.is_simple || state.is_joined || was_general) m_is_mixed = true;
    if (state.is_simple && body.shape == ImpactShape::kCircle) state.radius = body.half.x;
  }
  double reach = form.reach;
  if (form.shapes.empty())
    reach = length(0.5 * m_table->metric.fromCells(Vector::fromFixed(box.size))) + length(offset);
  if (form.shapes.empty() && !state.is_simple) {
    reach += length(m_table->metric.fromCells(Vector::fromFixed(box.corner)));
  }
  Vec2 path = {std::abs(state.start_velocity.x) + std::abs(state.flown.displacement.x),
               std::abs(state.start_velocity.y) + std::abs(state.flown.displacement.y)};
  if (state.must_be_held || (state.is_sprung && state.pull.spring.stiffness > kFollowed))
    path += swingOf(state);
  state.size = {reach + kRoom, reach + kRoom};
  state.reach = state.size + path;
}

// Gives all bodies that may be pushed, or may push others, to one SubstepWorld.
void BodyLayer::chooseFast() {
  for (State& state : m_states) {
    if (state.p_failure != nullptr) continue;
    if (state.is_kinematic) {
      state.is_near_substep = state.is_hard || m_links.isJoined(state.index);
    } else if (state.is_hard || state.is_joined || state.must_be_held) {
      state.solver = BodySolver::kSubstep;
      m_has_substeps = true;
    }
  }
}

void BodyLayer::chooseSolvers(const WorldStore& store) {
  m_islands.skip();
  m_has_substeps = false;
  if (std::exchange(m_was_fast, m_table->settings.is_fast)) m_islands.leaveSubsteps();
  if (m_table->settings.is_fast) {
    chooseFast();
    for (State& state : m_states) assignSolver(store, state);
    return;
  }
  if (m_is_mixed) {
    m_islands.chooseSolvers(store, *m_table, m_links, m_contacts, m_states);
    m_has_substeps = m_islands.hasGeneral();
  }
  for (State& state : m_states) assignSolver(store, state);
}

// Groups whose impacts cost too much are moved in soft sub-steps instead, from their state before the tick.
void BodyLayer::passOnGivenUp() {
  m_islands.passToSubsteps(*m_table, m_states);
  m_has_substeps = true;
  constexpr auto kSubstep = static_cast<std::uint8_t>(BodySolver::kSubstep);
  for (const State& state : m_states) {
    BodyRow& row = m_table->row(state.index);
    if (state.solver != BodySolver::kSubstep || row.last_solver == kSubstep) continue;
    m_impacts.passOn(state);
    row.last_solver = kSubstep;
    m_contacts.handOver(state.key);
  }
}

// Adds the body to its solver. If the solver has changed, the body's contacts must be found again: by it, or
// in this tick by the sensors if the body is not HARD any more.
void BodyLayer::assignSolver(const WorldStore& store, State& state) {
  BodyRow& row = m_table->row(state.index);
  const bool is_for_impacts = !m_table->settings.is_fast && state.is_simple && state.p_failure == nullptr &&
                              (state.solver == BodySolver::kFlight || state.solver == BodySolver::kImpact);
  if (is_for_impacts) {
    ImpactBody body;
    Vec2 offset;
    BodyImpacts::canHave(std::as_const(*m_table).form(state.index), m_table->metric,
                         store.box(state.key.slot), body, offset);
    state.solver =
        m_impacts.add(state, row, body, offset, m_contacts) ? BodySolver::kImpact : BodySolver::kFlight;
  }
  const auto solver = static_cast<std::uint8_t>(state.solver);
  if (row.last_solver != solver && !m_contacts.isEmpty())
    state.is_hard || state.p_failure != nullptr ? m_contacts.handOver(state.key)
                                                : m_contacts.expire(state.key);
  row.last_solver = solver;
}

// Rotates a body by its spin and torque if no contact or joint turns it.
void BodyLayer::turnByTorque(State& state) {
  const BodyGeometry& form = std::as_const(*m_table).form(state.index);
  if (form.spin == 0 && form.torque == 0) return;
  const auto at = static_cast<std::size_t>(&state - m_states.data());
  const double unit_inertia = m_unit_inertias[at];
  const double gain =
      unit_inertia > 0 ? m_table->row(state.index).inverse_mass / unit_inertia * form.torque : 0;
  state.spin = form.spin + gain;
  if (std::abs(state.spin) <= df::kMaxSpin) state.rotation = turned(form.rotation, form.spin + 0.5 * gain);
}

// Limits speeds to their maximum. A body outside the range of positions stays where it was.
void BodyLayer::limit(World& world, State& state) {
  const Vec2 fastest = m_table->metric.fromCells(Vector(kMaxVelocityCells, kMaxVelocityCells));
  const Vec2 velocity = {std::clamp(state.velocity.x, -fastest.x, fastest.x),
                         std::clamp(state.velocity.y, -fastest.y, fastest.y)};
  const double spin = std::clamp(state.spin, -df::kMaxSpin, df::kMaxSpin);
  const bool is_in_range = m_table->metric.isInRange(state.place);
  if (velocity == state.velocity && spin == state.spin && is_in_range) return;
  state.velocity = velocity;
  state.spin = spin;
  if (!is_in_range) state.place = m_table->row(state.index).place;
  countLimited(world, state);
}

// Counts bodies whose motion was limited, and logs the first one.
void BodyLayer::countLimited(World& world, const State& state) {
  if (++m_table->counters.limited > 1) return;
  const Object* p_object = world.store().find(state.key);
  world.log().write("physics: a " + (p_object != nullptr ? p_object->getType() : "body") +
                    " is too fast or too far away, so its motion is limited; further cases are only counted");
}

void BodyLayer::settle(World& world, State& state) {
  if (state.turns_alone) turnByTorque(state);
  if (state.p_failure != nullptr) return quarantine(world, state, state.p_failure);
  const bool is_finite = isFinite(state.velocity) && isFinite(Vec2{state.place.dx, state.place.dy}) &&
                         state.spin - state.spin == 0;
  if (!is_finite) return quarantine(world, state, kBeyond);
  limit(world, state);
  const auto velocity = toFixed(m_table->metric.toCells(state.velocity), kMaxVelocityCells);
  if (!velocity) return quarantine(world, state, kBeyond);
  BodyRow& row = m_table->row(state.index);
  row.place = state.place;
  row.velocity = state.velocity;
  const BodyGeometry& known = std::as_const(*m_table).form(state.index);
  if (known.spin != state.spin || known.torque != 0 || known.rotation != state.rotation) {
    BodyGeometry& form = m_table->form(state.index);
    form.rotation = state.rotation;
    form.spin = state.spin;
    form.torque = 0;
  }
  publish(world, state, row, *velocity);
}

void BodyLayer::publish(World& world, const State& state, BodyRow& row, FixedVector velocity) {
  WorldStore& store = world.store();
  const Metric& metric = m_table->metric;
  row.published_position = metric.fixedOf(row.place);
  row.published_velocity = velocity;
  store.setVelocity(row.key.slot, row.published_velocity);
  const auto change = toFixed(metric.toCells(state.acceleration), kMaxVelocityCells);
  store.setAcceleration(row.key.slot, change.value_or(FixedVector{}));
  store.set(row.key.slot, WorldStore::kDerive, true);
  if (row.published_position != store.position(row.key.slot))
    m_moved.push_back({row.key, row.published_position});
}

// Logs the first tick in which crowding makes bodies pass through others.
void BodyLayer::logCrowd(World& world) {
  const bool is_crowded =
      m_rigid_world.hasThinned() || m_substep_world.hasThinned() || m_heap_world.hasThinned();
  if (m_has_logged_crowd || !is_crowded) return;
  m_has_logged_crowd = true;
  world.log().write("physics: too many bodies in one place: some pass through others until there is room");
}

// Logs the first time that impulses had to be reduced because they would have added energy.
void BodyLayer::logScaling(World& world) {
  if (m_has_logged_scaling || m_has_logged_crowd || m_rigid_world.counters().scalings == 0) return;
  m_has_logged_scaling = true;
  world.log().write(
      "physics: a group of bodies could not be solved well and lost energy; further cases are only "
      "counted");
}

// Logs the first time that a heavy body sank into a light one which should bear it.
void BodyLayer::logSunk(World& world) {
  if (m_has_logged_sunk || m_substep_world.counters().sunk + m_heap_world.counters().sunk == 0) return;
  m_has_logged_sunk = true;
  world.log().write(
      "physics: a load sinks into a body that is too light to bear it; further cases are only counted");
}

// Freezes the body at its place, so that its invalid numbers do not spread to other bodies.
void BodyLayer::quarantine(World& world, State& state, const char* p_why) {
  BodyRow& row = m_table->row(state.index);
  ++m_table->counters.quarantined;
  row.frozen = true;
  row.velocity = {};
  m_contacts.expire(state.key);
  state.place = row.place;
  state.is_hard = state.is_soft = false;
  state.acceleration = {};
  if (std::as_const(*m_table).form(state.index).spin != 0) m_table->form(state.index).spin = 0;
  publish(world, state, row, {});
  const Object* p_object = world.store().find(row.key);
  world.log().write("physics: a " + (p_object != nullptr ? p_object->getType() : "body") +
                    " is frozen: " + p_why);
}

}  // namespace naiad::physics
