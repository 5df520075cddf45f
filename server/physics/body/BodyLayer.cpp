#include "physics/body/BodyLayer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyEvents.h"
#include "physics/body/BodyFlight.h"

namespace df {

namespace {

using naiad::physics::BodyForm;
using naiad::physics::BodyJoints;
using naiad::physics::BodyMedium;
using naiad::physics::BodyRow;
using naiad::physics::BodyTable;
using naiad::physics::BodyWay;
using naiad::physics::FlightKind;
using naiad::physics::Flown;
using naiad::physics::ImpactBody;
using naiad::physics::ImpactShape;
using naiad::physics::IntegratorStatus;
using naiad::physics::Vec2;

constexpr double kFarthest = 1e12;  // in a tick: displacements that no place can take are beyond the world
constexpr double kMaxSpin = 1e6;
constexpr const char* kBeyond = "it has left all bounds of place or velocity";

bool takesPart(const WorldStore& store, ObjectKey key) {
  constexpr std::uint32_t kNeeded = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kBody;
  return store.isCurrent(key) && (store.flags(key.slot) & kNeeded) == kNeeded;
}

}  // namespace

BodyLayer& BodyLayer::of(World& world) {
  if (auto* p_layer = world.findLayer<BodyLayer>()) return *p_layer;
  world.addLayer(std::make_unique<BodyLayer>());
  return *world.findLayer<BodyLayer>();
}

// First all go on, as they were at the beginning of the tick; then they are where they are, and handlers hear
// of it.
void BodyLayer::step(World& world) {
  m_moved.clear();
  m_plans.clear();
  m_unit_inertias.clear();
  m_touching.begin();
  m_is_mixed = false;
  m_links.prepare(*m_table);
  m_impacts.begin();
  for (const BodyTable::Index index : m_table->inOrder()) plan(world, index);
  ++m_table->ticks;
  choose(world.store());
  if (!m_links.isEmpty()) {
    m_links.step(*m_table, m_plans, m_unit_inertias, m_islands.meetings(), m_touching);
  }
  if (!m_impacts.isEmpty()) m_impacts.step(world, *m_table, m_plans, m_touching);
  if (m_is_mixed || !m_rigids.isEmpty()) {
    m_rigids.step(world.store(), *m_table, m_plans, m_unit_inertias, m_touching);
    tellOfCrowd(world);
  }
  for (Plan& plan : m_plans) settle(world, plan);
  for (const Moved& moved : m_moved) {
    if (takesPart(world.store(), moved.key)) world.place(moved.key, moved.where);
  }
  std::vector<naiad::physics::BodyContact>& news = m_touching.finish();
  m_touches.step(world.store(), *m_table, m_plans, news);
  if (!news.empty()) tellContacts(world, news);
}

void BodyLayer::plan(World& world, BodyTable::Index index) {
  BodyRow& row = m_table->row(index);
  const WorldStore& store = world.store();
  if (!store.isCurrent(row.key)) row.key = row.p_object->key();  // removed; perhaps inserted again
  if (!takesPart(store, row.key)) return;
  m_table->absorb(index, store.position(row.key.slot), store.velocity(row.key.slot));
  if (row.frozen) return;
  const BodyForm& form = std::as_const(*m_table).form(index);
  Plan& plan = m_plans.emplace_back();
  plan.index = index;
  plan.key = row.key;
  plan.order = store.order(row.key.slot);
  plan.is_hard = store.solidness(row.key.slot) == HARD;
  plan.is_soft = store.solidness(row.key.slot) == SOFT;
  plan.is_kinematic = row.is_kinematic;
  plan.is_joined = m_links.isJoined(index) && !row.is_kinematic;
  plan.start = row.place;
  plan.start_velocity = row.velocity;
  plan.rotation = form.rotation;
  plan.spin = form.spin;
  if (!row.is_kinematic) {
    plan.push = row.gravity_scale * m_table->gravity + row.inverse_mass * row.force;
    plan.acceleration = row.gravity_scale * m_table->gravity;
  }
  row.force = {};
  const bool turns = form.is_turning && !row.is_kinematic;
  m_unit_inertias.push_back(turns ? m_table->unitInertia(index, store.box(row.key.slot)) : 0);
  fly(plan);
  if (plan.is_joined) {
    plan.way = BodyWay::kJoined;
    // What is no constant force counts by what it does in the tick.
    if (plan.is_bent) plan.push = plan.flown.velocity - row.velocity;
  }
  if (plan.is_hard && plan.p_failure == nullptr) size(store, plan);
}

// On its own: where would it be?
void BodyLayer::fly(Plan& plan) {
  const BodyRow& row = m_table->row(plan.index);
  const BodyMedium& medium = std::as_const(*m_table).medium(plan.index);
  const auto time = static_cast<double>(m_table->ticks);
  IntegratorStatus status = IntegratorStatus::kDone;
  const naiad::physics::JointEntry* p_spring = row.is_kinematic ? nullptr : m_links.hangsOn(*m_table, plan.index);
  plan.is_bent = !row.is_kinematic && (p_spring != nullptr || row.flight != FlightKind::kFree);
  if (!plan.is_bent) {
    plan.flown = naiad::physics::flyFree(row.velocity, plan.push, 1);
  } else if (p_spring != nullptr) {
    status = flyHanging(row, medium, p_spring->joint, p_spring->anchor, plan.push, time, m_table->integrator,
                        plan.flown, m_table->counters.integrator);
  } else {
    status = flyBody(row, medium, plan.push, time, 1, m_table->integrator, plan.flown,
                     m_table->counters.integrator);
  }
  if (status != IntegratorStatus::kDone) plan.p_failure = "what moves it cannot be worked out";
  const bool is_near =
      isFinite(plan.flown.velocity) && lengthSquared(plan.flown.displacement) < kFarthest * kFarthest;
  if (plan.p_failure == nullptr && !is_near) plan.p_failure = kBeyond;
  if (plan.p_failure != nullptr) return;
  if (plan.is_bent) plan.acceleration = plan.flown.velocity - row.velocity;
  plan.place = row.place + plan.flown.displacement;
  plan.velocity = plan.flown.velocity;
}

// Is it one for an ImpactWorld, and how far does it reach?
void BodyLayer::size(const WorldStore& store, Plan& plan) {
  constexpr double kRoom = 0.25;
  const BodyForm& form = std::as_const(*m_table).form(plan.index);
  const FixedBox box = store.box(plan.key.slot);
  ImpactBody body;
  Vec2 offset;
  plan.is_simple =
      BodyImpacts::canHave(form, m_table->metric, box, body, offset) && !m_table->row(plan.index).meets_soft;
  if (!plan.is_simple || plan.is_joined) m_is_mixed = true;
  if (plan.is_simple && body.shape == ImpactShape::kCircle) plan.radius = body.half.x;
  double reach = 0;
  for (const naiad::physics::ConvexShape& shape : form.shapes)
    reach = std::max(reach, shape.reach + shape.radius);
  if (form.shapes.empty())
    reach = length(0.5 * m_table->metric.fromCells(Vector::fromFixed(box.size))) + length(offset);
  if (form.shapes.empty() && !plan.is_simple) {
    reach += length(m_table->metric.fromCells(Vector::fromFixed(box.corner)));
  }
  const Vec2 way = {std::abs(plan.start_velocity.x) + std::abs(plan.flown.displacement.x),
                    std::abs(plan.start_velocity.y) + std::abs(plan.flown.displacement.y)};
  plan.reach = Vec2{reach + kRoom, reach + kRoom} + way;
}

void BodyLayer::choose(const WorldStore& store) {
  m_islands.skip();
  if (m_is_mixed) m_islands.choose(store, *m_table, m_links, m_touching, m_plans);
  if (m_is_mixed || m_links.hasLeftOut()) m_links.leaveOut(*m_table, m_plans);
  for (Plan& plan : m_plans) hand(store, plan);
}

// To whom it goes; and if that is somebody else than in the last tick, whom it touched is an open question.
void BodyLayer::hand(const WorldStore& store, Plan& plan) {
  BodyRow& row = m_table->row(plan.index);
  const bool is_for_impacts = plan.is_simple && plan.p_failure == nullptr &&
                              (plan.way == BodyWay::kAlone || plan.way == BodyWay::kImpact);
  if (is_for_impacts) {
    ImpactBody body;
    Vec2 offset;
    BodyImpacts::canHave(std::as_const(*m_table).form(plan.index), m_table->metric, store.box(plan.key.slot),
                         body, offset);
    plan.way = m_impacts.enter(plan, row, body, offset) ? BodyWay::kImpact : BodyWay::kAlone;
  }
  const auto way = static_cast<std::uint8_t>(plan.way);
  if (row.last_way != way && !m_touching.isEmpty()) m_touching.hand(plan.key);
  row.last_way = way;
}

// What nothing turns but its torque.
void BodyLayer::turnAlone(Plan& plan) {
  const BodyForm& form = std::as_const(*m_table).form(plan.index);
  if (form.spin == 0 && form.torque == 0) return;
  const auto at = static_cast<std::size_t>(&plan - m_plans.data());
  const double unit_inertia = m_unit_inertias[at];
  const double gain =
      unit_inertia > 0 ? m_table->row(plan.index).inverse_mass / unit_inertia * form.torque : 0;
  plan.spin = form.spin + gain;
  if (std::abs(plan.spin) <= kMaxSpin) plan.rotation = turned(form.rotation, form.spin + 0.5 * gain);
}

void BodyLayer::settle(World& world, Plan& plan) {
  const bool is_on_joints = plan.way == BodyWay::kJoined || (plan.way == BodyWay::kStruck && plan.is_joined);
  if (!is_on_joints && plan.turns_alone) turnAlone(plan);
  if (plan.p_failure != nullptr) return quarantine(world, plan, plan.p_failure);
  const auto velocity = toFixed(m_table->metric.toCells(plan.velocity), kMaxVelocityCells);
  const bool is_sound = velocity && m_table->metric.isInRange(plan.place) && std::abs(plan.spin) <= kMaxSpin;
  if (!is_sound) return quarantine(world, plan, kBeyond);
  BodyRow& row = m_table->row(plan.index);
  row.place = plan.place;
  row.velocity = plan.velocity;
  const BodyForm& known = std::as_const(*m_table).form(plan.index);
  if (known.spin != plan.spin || known.torque != 0 || known.rotation != plan.rotation) {
    BodyForm& form = m_table->form(plan.index);
    form.rotation = plan.rotation;
    form.spin = plan.spin;
    form.torque = 0;
  }
  tell(world, plan, row, *velocity);
}

void BodyLayer::tell(World& world, const Plan& plan, BodyRow& row, FixedVector velocity) {
  WorldStore& store = world.store();
  const naiad::physics::Metric& metric = m_table->metric;
  row.told_position = metric.fixedOf(row.place);
  row.told_velocity = velocity;
  store.setVelocity(row.key.slot, row.told_velocity);
  const auto change = toFixed(metric.toCells(plan.acceleration), kMaxVelocityCells);
  store.setAcceleration(row.key.slot, change.value_or(FixedVector{}));
  store.set(row.key.slot, WorldStore::kDerive, true);
  if (row.told_position != store.position(row.key.slot)) m_moved.push_back({row.key, row.told_position});
}

// Once: it counts on in RigidCounters::passed.
void BodyLayer::tellOfCrowd(World& world) {
  if (m_has_told_of_crowd || m_rigids.counters().passed == 0) return;
  m_has_told_of_crowd = true;
  world.log("physics: too many bodies in one place: some pass through one another until there is room");
}

// It stands where it is, so that nothing of it spreads.
void BodyLayer::quarantine(World& world, Plan& plan, const char* p_why) {
  BodyRow& row = m_table->row(plan.index);
  ++m_table->counters.quarantined;
  row.frozen = true;
  row.velocity = {};
  m_touching.doubt(plan.key);
  plan.place = row.place;
  plan.is_hard = plan.is_soft = false;
  plan.acceleration = {};
  if (std::as_const(*m_table).form(plan.index).spin != 0) m_table->form(plan.index).spin = 0;
  tell(world, plan, row, {});
  const Object* p_object = world.find(row.key);
  world.log("physics: a " + (p_object != nullptr ? p_object->getType() : "body") + " is frozen: " + p_why);
}

}  // namespace df
