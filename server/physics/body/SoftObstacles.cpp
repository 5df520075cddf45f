#include "physics/body/SoftObstacles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/BodyLimits.h"
#include "physics/body/BodyObstacles.h"

namespace naiad::physics {

namespace {

// Sub-steps change an obstacle's velocity before they move it. So its path starts half a sub-step ahead.
constexpr double kAhead = 0.5 / SoftWorld::kDefaultSubsteps;

// True if the body of this state still takes part after handlers have run.
bool isThere(const WorldStore& store, const BodyTable& table, const BodyState& state) {
  const BodyRow& row = table.row(state.index);
  return row.used && row.key == state.key && store.isCurrent(state.key) && !row.frozen &&
         store.has(state.key.slot, WorldStore::kActive);
}

bool areApart(Vec2 offset, Vec2 reach) {
  return !(std::fabs(offset.x) <= reach.x && std::fabs(offset.y) <= reach.y);
}

}  // namespace

void SoftObstacles::clear() {
  m_sources.clear();
  m_obstacles.clear();
  m_shapes.clear();
}

bool SoftObstacles::isKnown(int id) const {
  return std::any_of(m_obstacles.begin(), m_obstacles.end(),
                     [id](const SoftObstacle& o) { return o.id == id; });
}

void SoftObstacles::sum(ObjectKey key, FixedVector where, const FixedBox& box) {
  const auto mix = [this](std::uint64_t value) {
    m_sum = (m_sum ^ value) * 0x100000001b3u;
    m_sum ^= m_sum >> 29;
  };
  mix(key.slot);
  mix(key.generation);
  for (const Fixed f : {where.x, where.y, box.corner.x, box.corner.y, box.size.x, box.size.y}) {
    mix(static_cast<std::uint64_t>(f));
  }
}

void SoftObstacles::gather(const World& world, const BodyLayer& bodies, SoftTable& table, int id,
                           Vec2 reach) {
  m_sum = 0xcbf29ce484222325u;
  m_is_lively = false;
  const SoftEntry& entry = table.entry(id);
  const WorldStore& store = world.store();
  m_found.clear();
  store.touching(regionOf(table.metric(), entry.centre, reach), entry.key.slot, m_found);
  for (const ObjectKey key : m_found) {
    if (BodyObstacles::isObstacle(store, key)) addObject(world, table.bodies(), key);
  }
  const std::vector<BodyState>& states = bodies.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BodyState& state = states[i];
    const bool is_held =
        std::any_of(entry.attached_nodes.begin(), entry.attached_nodes.end(),
                    [&](const SoftAttachedNode& attached) { return attached.key == state.key; });
    if (!is_held && (!state.is_hard || areApart(state.start - entry.centre, reach + state.reach))) continue;
    addBody(world, bodies, table.bodies(), static_cast<int>(i));
  }
}

void SoftObstacles::addObject(const World& world, const BodyTable& table, ObjectKey key) {
  const WorldStore& store = world.store();
  const FixedBox box = store.box(key.slot);
  sum(key, store.position(key.slot), box);
  if (isKnown(static_cast<int>(key.slot))) return;
  const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
  ConvexShape shape;
  if (makeBox(half.x, half.y, {}, {}, 0, shape) != ShapeStatus::kOk) return;
  SoftObstacle obstacle;
  obstacle.id = static_cast<int>(key.slot);
  obstacle.place = table.metric.placeOf(store.position(key.slot) + box.corner) + half;
  obstacle.friction = table.settings.obstacle_friction;
  Source source;
  source.key = key;
  source.shape = static_cast<int>(m_shapes.size());
  m_shapes.push_back(shape);
  m_sources.push_back(source);
  m_obstacles.push_back(obstacle);
}

// Adds a body as an obstacle that repeats the body's path of this tick: it starts where the body started,
// with a velocity and a constant acceleration that lead to the body's present place.
void SoftObstacles::addBody(const World& world, const BodyLayer& bodies, const BodyTable& table, int state) {
  const BodyState& its = bodies.states()[static_cast<std::size_t>(state)];
  const WorldStore& store = world.store();
  if (!isThere(store, table, its)) return;
  const BodyRow& row = table.row(its.index);
  const BodyGeometry& form = table.form(its.index);
  const FixedBox box = store.box(its.key.slot);
  sum(its.key, store.position(its.key.slot), box);
  if (row.velocity != Vec2{} || form.spin != 0) m_is_lively = true;
  if (isKnown(static_cast<int>(its.key.slot))) return;
  SoftObstacle obstacle;
  Source source;
  obstacle.id = static_cast<int>(its.key.slot);
  source.key = its.key;
  source.state = state;
  obstacle.inverse_mass = row.inverse_mass;
  const bool turns = form.is_turning && !row.is_kinematic;
  const double unit_inertia = turns ? table.unitInertia(its.index, box) : 0;
  obstacle.inverse_inertia = unit_inertia > 0 ? row.inverse_mass / unit_inertia : 0;
  obstacle.friction = row.friction;
  if (const Pushed* p_pushed = findPushed(its.key)) {
    source.gained = obstacle.inverse_mass * p_pushed->impulse;
    source.turned = obstacle.inverse_inertia * p_pushed->angular_impulse;
  }
  const bool is_carried = bodies.isTouching(its.key);
  const Vec2 displacement =
      row.place == its.place ? its.place - its.start : Vec2{};  // zero if a handler has moved the body
  const Vec2 change = is_carried ? Vec2{} : its.velocity - its.start_velocity;
  obstacle.acceleration = change - source.gained;
  obstacle.velocity = displacement - 0.5 * change;
  obstacle.place = row.place + (kAhead * obstacle.velocity - displacement);
  const double turn = is_carried ? 0 : source.turned, spin = form.spin - turn;
  obstacle.spin = spin + (0.5 + kAhead) * (turn - source.turned);
  obstacle.rotation = turned(form.rotation, kAhead * spin - (spin + 0.5 * turn));
  if (!setShape(store, table, its, obstacle, source) || !isValid(obstacle)) return;
  m_sources.push_back(source);
  m_obstacles.push_back(obstacle);
}

bool SoftObstacles::setShape(const WorldStore& store, const BodyTable& table, const BodyState& state,
                             SoftObstacle& obstacle, Source& source) {
  if (store.solidness(state.key.slot) != HARD) return true;  // then only attached nodes act on it
  const BodyGeometry& form = table.form(state.index);
  if (!form.shapes.empty()) {
    obstacle.shapes = form.shapes;
    return true;
  }
  const FixedBox box = store.box(state.key.slot);
  const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
  const Vec2 centre = table.metric.fromCells(Vector::fromFixed(box.corner)) + half;
  ConvexShape shape;
  if (makeBox(half.x, half.y, centre, {}, 0, shape) != ShapeStatus::kOk) return false;
  source.shape = static_cast<int>(m_shapes.size());
  m_shapes.push_back(shape);
  return true;
}

// Adds the grab as an obstacle. It has the mass of the dragged soft body, so that its spring is neither too
// stiff for a tick nor too slow.
void SoftObstacles::addGrab(const SoftTable& /*table*/, const SoftEntry& entry, int id) {
  constexpr double kStiffness = 0.1, kDamping = 0.9;  // per tick² and per tick, for each unit of mass
  const SoftGrab& grab = entry.grab;
  if (grab.attachment < 0) return;
  Vec2 pull = kStiffness * (grab.target - grab.place) - kDamping * grab.velocity;
  const double most = grab.strength / entry.mass, pulls = length(pull);
  if (pulls > most) pull = pull * (most / pulls);
  SoftObstacle obstacle;
  obstacle.id = kFirstGrabId + id;
  obstacle.place = grab.place;
  obstacle.velocity = grab.velocity;
  obstacle.acceleration = pull;
  obstacle.inverse_mass = 1 / entry.mass;
  if (!isValid(obstacle)) return;
  Source source;
  source.grab = id;
  m_sources.push_back(source);
  m_obstacles.push_back(obstacle);
}

std::vector<SoftObstacle>& SoftObstacles::all() {
  for (std::size_t i = 0; i < m_sources.size(); ++i) {
    if (m_sources[i].shape >= 0)
      m_obstacles[i].shapes = {&m_shapes[static_cast<std::size_t>(m_sources[i].shape)], 1};
  }
  return m_obstacles;
}

const SoftObstacles::Pushed* SoftObstacles::findPushed(ObjectKey key) {
  for (Pushed& pushed : m_pushed) {
    if (pushed.key != key) continue;
    pushed.is_near = true;
    return &pushed;
  }
  return nullptr;
}

// Removes the impulse that was expected for this tick from bodies that are no longer near a soft body.
void SoftObstacles::removeStaleImpulses(const BodyLayer& bodies, BodyTable& table) {
  for (const Pushed& pushed : m_pushed) {
    BodyRow& row = table.row(pushed.index);
    if (row.key != pushed.key) continue;
    row.touches_soft = false;
    if (!pushed.is_near && !bodies.isTouching(pushed.key)) row.velocity -= row.inverse_mass * pushed.impulse;
  }
}

void SoftObstacles::apply(World& world, BodyLayer& bodies, SoftTable& table,
                          std::vector<MovedObject>& moved) {
  removeStaleImpulses(bodies, table.bodies());
  m_pushing.clear();
  for (std::size_t i = 0; i < m_sources.size(); ++i) {
    const Source& source = m_sources[i];
    const SoftObstacle& obstacle = m_obstacles[i];
    const bool is_pushed = obstacle.impulse != Vec2{} || obstacle.angular_impulse != 0 ||
                           source.gained != Vec2{} || source.turned != 0;
    if (source.grab >= 0) {
      SoftGrab& grab = table.entry(source.grab).grab;
      grab.place = grab.place + obstacle.displacement;
      grab.velocity = obstacle.velocity + obstacle.acceleration + obstacle.inverse_mass * obstacle.impulse;
    } else if (source.state >= 0 && is_pushed) {
      push(world, bodies, table.bodies(), source, obstacle, moved);
    }
  }
  m_pushed.swap(m_pushing);
}

void SoftObstacles::push(World& world, const BodyLayer& bodies, BodyTable& table, const Source& source,
                         const SoftObstacle& obstacle, std::vector<MovedObject>& moved) {
  const BodyTable::Index index = bodies.states()[static_cast<std::size_t>(source.state)].index;
  BodyRow& row = table.row(index);
  if (row.inverse_mass == 0) return;
  const Metric& metric = table.metric;
  const Vec2 gain = obstacle.inverse_mass * obstacle.impulse;
  const double turning = obstacle.inverse_inertia * obstacle.angular_impulse;
  const Vec2 velocity = row.velocity + (gain - source.gained);
  const double spin = std::as_const(table).form(index).spin + (turning - source.turned);
  const Vec2 end = obstacle.velocity + obstacle.acceleration + gain;
  const Place place = obstacle.place + (obstacle.displacement - kAhead * end);
  const bool is_sound = toFixed(metric.toCells(velocity), kMaxVelocityCells) && metric.isInRange(place) &&
                        std::fabs(spin) <= df::kMaxSpin;
  if (!is_sound) return;
  row.velocity = velocity;
  row.place = place;
  // Expects the mean of the old and the new impulse, because the new one alone would alternate.
  const Vec2 expected = 0.5 * (obstacle.impulse + source.gained / obstacle.inverse_mass);
  const double before = obstacle.inverse_inertia > 0 ? source.turned / obstacle.inverse_inertia : 0;
  const double expected_turn = 0.5 * (obstacle.angular_impulse + before);
  row.force += expected;
  row.touches_soft = true;
  if (obstacle.inverse_inertia > 0) {
    BodyGeometry& form = table.form(index);
    form.spin = spin;
    form.rotation = turned(obstacle.rotation, obstacle.turn - kAhead * spin);
    form.torque += expected_turn;
  }
  m_pushing.push_back({index, source.key, {}, expected, expected_turn, false});
  publish(world, table, m_pushing.back(), moved);
}

// Publishes a body that hardly moves as still, at its last position, so that bodies at rest need no bytes.
void SoftObstacles::publish(World& world, BodyTable& table, Pushed& pushed, std::vector<MovedObject>& moved) {
  constexpr double kCalm = 1e-3;  // metric cells, and metric cells per tick
  BodyRow& row = table.row(pushed.index);
  pushed.published = table.metric.fixedOf(row.place);
  const bool is_calm = std::fabs(row.velocity.x) < kCalm && std::fabs(row.velocity.y) < kCalm;
  for (const Pushed& before : m_pushed) {
    const Vec2 off = table.metric.placeOf(before.published) - row.place;
    const bool is_same =
        is_calm && before.key == pushed.key && std::fabs(off.x) < kCalm && std::fabs(off.y) < kCalm;
    if (is_same) pushed.published = before.published;
  }
  const auto velocity = toFixed(table.metric.toCells(row.velocity), kMaxVelocityCells);
  row.published_velocity = is_calm ? FixedVector{} : velocity.value_or(FixedVector{});
  row.published_position = pushed.published;
  WorldStore& store = world.store();
  store.setVelocity(row.key.slot, row.published_velocity);
  store.setAcceleration(row.key.slot, {});
  if (row.published_position != store.position(row.key.slot))
    moved.push_back({row.key, row.published_position});
}

ObjectKey SoftObstacles::keyOf(int obstacle) const {
  for (std::size_t i = 0; i < m_sources.size(); ++i) {
    if (m_obstacles[i].id == obstacle) return m_sources[i].key;
  }
  return {};
}

}  // namespace naiad::physics
