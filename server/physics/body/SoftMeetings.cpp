#include "physics/body/SoftMeetings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/WorldStore.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/BodyObstacles.h"

namespace df {

namespace {

using naiad::physics::BodyForm;
using naiad::physics::BodyPlan;
using naiad::physics::BodyRow;
using naiad::physics::BodyTable;
using naiad::physics::Metric;
using naiad::physics::MovedObject;
using RawShape = naiad::physics::ConvexShape;
using naiad::physics::ShapeStatus;
using naiad::physics::SoftHand;
using naiad::physics::SoftObstacle;
using naiad::physics::SoftSeat;
using naiad::physics::SoftTable;
using naiad::physics::SoftWorld;
using naiad::physics::Vec2;

constexpr double kMaxSpin = 1e6;
// The sub-steps change an obstacle's velocity first, and then move it: so it is half a sub-step ahead.
constexpr double kAhead = 0.5 / SoftWorld::kDefaultSubsteps;

// Is the body of this plan still there, after handlers have run?
bool isThere(const WorldStore& store, const BodyTable& table, const BodyPlan& plan) {
  const BodyRow& row = table.row(plan.index);
  return row.used && row.key == plan.key && store.isCurrent(plan.key) && !row.frozen &&
         store.has(plan.key.slot, WorldStore::kActive);
}

bool areApart(Vec2 way, Vec2 reach) {
  return !(std::fabs(way.x) <= reach.x && std::fabs(way.y) <= reach.y);
}

}  // namespace

void SoftMeetings::begin() {
  m_met.clear();
  m_obstacles.clear();
  m_shapes.clear();
}

bool SoftMeetings::isKnown(int id) const {
  return std::any_of(m_obstacles.begin(), m_obstacles.end(),
                     [id](const SoftObstacle& o) { return o.id == id; });
}

void SoftMeetings::sum(ObjectKey key, FixedVector where, const FixedBox& box) {
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

void SoftMeetings::gather(const World& world, const BodyLayer& bodies, SoftTable& table, int id, Vec2 reach) {
  m_sum = 0xcbf29ce484222325u;
  m_is_lively = false;
  const SoftSeat& seat = table.seat(id);
  const WorldStore& store = world.store();
  m_found.clear();
  store.touching(regionOf(table.metric(), seat.centre, reach), seat.key.slot, m_found);
  for (const ObjectKey key : m_found) {
    if (BodyObstacles::isOne(store, key)) addObject(world, table.bodies(), key);
  }
  const std::vector<BodyPlan>& plans = bodies.plans();
  for (std::size_t i = 0; i < plans.size(); ++i) {
    const BodyPlan& plan = plans[i];
    const bool is_held =
        std::any_of(seat.holds.begin(), seat.holds.end(),
                    [&](const naiad::physics::SoftHold& hold) { return hold.key == plan.key; });
    if (!is_held && (!plan.is_hard || areApart(plan.start - seat.centre, reach + plan.reach))) continue;
    addBody(world, bodies, table.bodies(), static_cast<int>(i));
  }
}

void SoftMeetings::addObject(const World& world, const BodyTable& table, ObjectKey key) {
  const WorldStore& store = world.store();
  const FixedBox box = store.box(key.slot);
  sum(key, store.position(key.slot), box);
  if (isKnown(static_cast<int>(key.slot))) return;
  const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
  RawShape shape;
  if (makeBox(half.x, half.y, {}, {}, 0, shape) != ShapeStatus::kOk) return;
  SoftObstacle obstacle;
  obstacle.id = static_cast<int>(key.slot);
  obstacle.place = table.metric.placeOf(store.position(key.slot) + box.corner) + half;
  obstacle.friction = table.obstacle_friction;
  Met met;
  met.key = key;
  met.shape = static_cast<int>(m_shapes.size());
  m_shapes.push_back(shape);
  m_met.push_back(met);
  m_obstacles.push_back(obstacle);
}

// It is seen on the way that it has gone in this tick, from its beginning on: with a velocity and a constant
// acceleration that bring it where it is.
void SoftMeetings::addBody(const World& world, const BodyLayer& bodies, const BodyTable& table, int plan) {
  const BodyPlan& its = bodies.plans()[static_cast<std::size_t>(plan)];
  const WorldStore& store = world.store();
  if (!isThere(store, table, its)) return;
  const BodyRow& row = table.row(its.index);
  const BodyForm& form = table.form(its.index);
  const FixedBox box = store.box(its.key.slot);
  sum(its.key, store.position(its.key.slot), box);
  if (row.velocity != Vec2{} || form.spin != 0) m_is_lively = true;
  if (isKnown(static_cast<int>(its.key.slot))) return;
  SoftObstacle obstacle;
  Met met;
  obstacle.id = static_cast<int>(its.key.slot);
  met.key = its.key;
  met.plan = plan;
  obstacle.inverse_mass = row.inverse_mass;
  const bool turns = form.is_turning && !row.is_kinematic;
  const double unit_inertia = turns ? table.unitInertia(its.index, box) : 0;
  obstacle.inverse_inertia = unit_inertia > 0 ? row.inverse_mass / unit_inertia : 0;
  obstacle.friction = row.friction;
  if (const Pushed* p_pushed = pushedBefore(its.key)) {
    met.gained = obstacle.inverse_mass * p_pushed->impulse;
    met.turned = obstacle.inverse_inertia * p_pushed->angular_impulse;
  }
  const bool is_carried = bodies.isTouching(its.key);
  const Vec2 way = row.place == its.place ? its.place - its.start : Vec2{};  // or a handler has put it there
  const Vec2 change = is_carried ? Vec2{} : its.velocity - its.start_velocity;
  obstacle.acceleration = change - met.gained;
  obstacle.velocity = way - 0.5 * change;
  obstacle.place = row.place + (kAhead * obstacle.velocity - way);
  const double turn = is_carried ? 0 : met.turned, spin = form.spin - turn;
  obstacle.spin = spin + (0.5 + kAhead) * (turn - met.turned);
  obstacle.rotation = turned(form.rotation, kAhead * spin - (spin + 0.5 * turn));
  if (!giveShape(store, table, its, obstacle, met) || !isSound(obstacle)) return;
  m_met.push_back(met);
  m_obstacles.push_back(obstacle);
}

bool SoftMeetings::giveShape(const WorldStore& store, const BodyTable& table, const BodyPlan& plan,
                             SoftObstacle& obstacle, Met& met) {
  if (store.solidness(plan.key.slot) != HARD) return true;  // it is only held
  const BodyForm& form = table.form(plan.index);
  if (!form.shapes.empty()) {
    obstacle.shapes = form.shapes;
    return true;
  }
  const FixedBox box = store.box(plan.key.slot);
  const Vec2 half = 0.5 * table.metric.fromCells(Vector::fromFixed(box.size));
  const Vec2 centre = table.metric.fromCells(Vector::fromFixed(box.corner)) + half;
  RawShape shape;
  if (makeBox(half.x, half.y, centre, {}, 0, shape) != ShapeStatus::kOk) return false;
  met.shape = static_cast<int>(m_shapes.size());
  m_shapes.push_back(shape);
  return true;
}

// As heavy as what it drags, so that its spring is neither too stiff for a tick nor too slow.
void SoftMeetings::addHand(const SoftTable& /*table*/, const SoftSeat& seat, int id) {
  constexpr double kStiffness = 0.1, kDamping = 0.9;
  const SoftHand& hand = seat.hand;
  if (hand.attachment < 0) return;
  Vec2 pull = kStiffness * (hand.target - hand.place) - kDamping * hand.velocity;
  const double most = hand.strength / seat.mass, pulls = length(pull);
  if (pulls > most) pull = pull * (most / pulls);
  SoftObstacle obstacle;
  obstacle.id = kHands + id;
  obstacle.place = hand.place;
  obstacle.velocity = hand.velocity;
  obstacle.acceleration = pull;
  obstacle.inverse_mass = 1 / seat.mass;
  if (!isSound(obstacle)) return;
  Met met;
  met.hand = id;
  m_met.push_back(met);
  m_obstacles.push_back(obstacle);
}

std::vector<SoftObstacle>& SoftMeetings::obstacles() {
  for (std::size_t i = 0; i < m_met.size(); ++i) {
    if (m_met[i].shape >= 0) m_obstacles[i].shapes = {&m_shapes[static_cast<std::size_t>(m_met[i].shape)], 1};
  }
  return m_obstacles;
}

const SoftMeetings::Pushed* SoftMeetings::pushedBefore(ObjectKey key) {
  for (Pushed& pushed : m_pushed) {
    if (pushed.key != key) continue;
    pushed.is_met = true;
    return &pushed;
  }
  return nullptr;
}

// Of those whom no soft body is near any more: what was taken for this tick's push has not come.
void SoftMeetings::takeBack(const BodyLayer& bodies, BodyTable& table) {
  for (const Pushed& pushed : m_pushed) {
    BodyRow& row = table.row(pushed.index);
    if (row.key != pushed.key) continue;
    row.meets_soft = false;
    if (!pushed.is_met && !bodies.isTouching(pushed.key)) row.velocity -= row.inverse_mass * pushed.impulse;
  }
}

void SoftMeetings::apply(World& world, BodyLayer& bodies, SoftTable& table, std::vector<MovedObject>& moved) {
  takeBack(bodies, table.bodies());
  m_pushing.clear();
  for (std::size_t i = 0; i < m_met.size(); ++i) {
    const Met& met = m_met[i];
    const SoftObstacle& obstacle = m_obstacles[i];
    const bool is_pushed = obstacle.impulse != Vec2{} || obstacle.angular_impulse != 0 ||
                           met.gained != Vec2{} || met.turned != 0;
    if (met.hand >= 0) {
      SoftHand& hand = table.seat(met.hand).hand;
      hand.place = hand.place + obstacle.displacement;
      hand.velocity = obstacle.velocity + obstacle.acceleration + obstacle.inverse_mass * obstacle.impulse;
    } else if (met.plan >= 0 && is_pushed) {
      push(world, bodies, table.bodies(), met, obstacle, moved);
    }
  }
  m_pushed.swap(m_pushing);
}

void SoftMeetings::push(World& world, const BodyLayer& bodies, BodyTable& table, const Met& met,
                        const SoftObstacle& obstacle, std::vector<MovedObject>& moved) {
  const BodyTable::Index index = bodies.plans()[static_cast<std::size_t>(met.plan)].index;
  BodyRow& row = table.row(index);
  if (row.inverse_mass == 0) return;
  const Metric& metric = table.metric;
  const Vec2 gain = obstacle.inverse_mass * obstacle.impulse;
  const double turning = obstacle.inverse_inertia * obstacle.angular_impulse;
  const Vec2 velocity = row.velocity + (gain - met.gained);
  const double spin = std::as_const(table).form(index).spin + (turning - met.turned);
  const Vec2 end = obstacle.velocity + obstacle.acceleration + gain;
  const naiad::physics::Place place = obstacle.place + (obstacle.displacement - kAhead * end);
  const bool is_sound = toFixed(metric.toCells(velocity), kMaxVelocityCells) && metric.isInRange(place) &&
                        std::fabs(spin) <= kMaxSpin;
  if (!is_sound) return;
  row.velocity = velocity;
  row.place = place;
  // Half of what is new: the whole would swing to and fro between the two steps.
  const Vec2 expected = 0.5 * (obstacle.impulse + met.gained / obstacle.inverse_mass);
  const double before = obstacle.inverse_inertia > 0 ? met.turned / obstacle.inverse_inertia : 0;
  const double expected_turn = 0.5 * (obstacle.angular_impulse + before);
  row.force += expected;
  row.meets_soft = true;
  if (obstacle.inverse_inertia > 0) {
    BodyForm& form = table.form(index);
    form.spin = spin;
    form.rotation = turned(obstacle.rotation, obstacle.turn - kAhead * spin);
    form.torque += expected_turn;
  }
  m_pushing.push_back({index, met.key, {}, expected, expected_turn, false});
  tell(world, table, m_pushing.back(), moved);
}

// What hardly moves is told as still, where it was told before.
void SoftMeetings::tell(World& world, BodyTable& table, Pushed& pushed, std::vector<MovedObject>& moved) {
  constexpr double kCalm = 1e-3;
  BodyRow& row = table.row(pushed.index);
  pushed.told = table.metric.fixedOf(row.place);
  const bool is_calm = std::fabs(row.velocity.x) < kCalm && std::fabs(row.velocity.y) < kCalm;
  for (const Pushed& before : m_pushed) {
    const Vec2 off = table.metric.placeOf(before.told) - row.place;
    const bool is_same =
        is_calm && before.key == pushed.key && std::fabs(off.x) < kCalm && std::fabs(off.y) < kCalm;
    if (is_same) pushed.told = before.told;
  }
  const auto velocity = toFixed(table.metric.toCells(row.velocity), kMaxVelocityCells);
  row.told_velocity = is_calm ? FixedVector{} : velocity.value_or(FixedVector{});
  row.told_position = pushed.told;
  WorldStore& store = world.store();
  store.setVelocity(row.key.slot, row.told_velocity);
  store.setAcceleration(row.key.slot, {});
  if (row.told_position != store.position(row.key.slot)) moved.push_back({row.key, row.told_position});
}

ObjectKey SoftMeetings::keyOf(int obstacle) const {
  for (std::size_t i = 0; i < m_met.size(); ++i) {
    if (m_obstacles[i].id == obstacle) return m_met[i].key;
  }
  return {};
}

bool SoftMeetings::isMovable(int obstacle) const {
  const auto found = std::find_if(m_obstacles.begin(), m_obstacles.end(),
                                  [obstacle](const SoftObstacle& o) { return o.id == obstacle; });
  return found != m_obstacles.end() && found->inverse_mass > 0;
}

}  // namespace df
