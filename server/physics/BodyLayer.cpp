#include "BodyLayer.h"

#include <string>

#include "BodyFlight.h"
#include "Object.h"
#include "World.h"
#include "WorldStore.h"

namespace df {

namespace {

using naiad::physics::BodyMedium;
using naiad::physics::BodyTable;
using naiad::physics::Flown;
using naiad::physics::IntegratorStatus;
using naiad::physics::Vec2;

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

// First all fly, as they were at the beginning of the tick; then they are where they are, and handlers hear
// of it.
void BodyLayer::step(World& world) {
  m_moved.clear();
  for (const BodyTable::Index index : m_table->inOrder()) fly(world, index);
  ++m_table->ticks;
  for (const Moved& moved : m_moved) {
    if (takesPart(world.store(), moved.key)) world.place(moved.key, moved.where);
  }
}

void BodyLayer::fly(World& world, BodyTable::Index index) {
  Row& row = m_table->row(index);
  WorldStore& store = world.store();
  if (!store.isCurrent(row.key)) row.key = row.p_object->key();  // removed; perhaps inserted again
  if (!takesPart(store, row.key)) return;
  m_table->absorb(index, store.position(row.key.slot), store.velocity(row.key.slot));
  if (row.frozen) return;
  const Vec2 push = row.gravity_scale * m_table->gravity + row.inverse_mass * row.force;
  row.force = {};
  Flown flown;
  const IntegratorStatus status =
      flyBody(row, std::as_const(*m_table).medium(index), push, static_cast<double>(m_table->ticks), 1,
              m_table->integrator, flown, m_table->counters.integrator);
  if (status != IntegratorStatus::kDone) return quarantine(world, row, "what moves it cannot be worked out");
  // Displacements that no place can take are far beyond the world.
  constexpr double kFarthest = 1e12;
  const bool near = length(flown.displacement) < kFarthest;
  const naiad::physics::Place place = near ? row.place + flown.displacement : row.place;
  const auto velocity = toFixed(m_table->metric.toCells(flown.velocity), kMaxVelocityCells);
  if (!near || !m_table->metric.isInRange(place) || !velocity) {
    return quarantine(world, row, "it has left all bounds of place or velocity");
  }
  const Vec2 change = flown.velocity - row.velocity;
  row.place = place;
  row.velocity = flown.velocity;
  // What a watcher extrapolates with: exact for a constant force, near for others.
  const bool constant = row.flight == naiad::physics::FlightKind::kFree;
  tell(world, row, constant ? row.gravity_scale * m_table->gravity : change);
}

void BodyLayer::tell(World& world, Row& row, Vec2 acceleration) {
  WorldStore& store = world.store();
  const naiad::physics::Metric& metric = m_table->metric;
  row.told_position = metric.fixedOf(row.place);
  row.told_velocity = *toFixed(metric.toCells(row.velocity), kMaxVelocityCells);
  store.setVelocity(row.key.slot, row.told_velocity);
  const auto change = toFixed(metric.toCells(acceleration), kMaxVelocityCells);
  store.setAcceleration(row.key.slot, change.value_or(FixedVector{}));
  store.set(row.key.slot, WorldStore::kDerive, true);
  if (row.told_position != store.position(row.key.slot)) m_moved.push_back({row.key, row.told_position});
}

// It stands where it is, so that nothing of it spreads.
void BodyLayer::quarantine(World& world, Row& row, const char* why) {
  ++m_table->counters.quarantined;
  row.frozen = true;
  row.velocity = {};
  tell(world, row, {});
  const Object* p_object = world.find(row.key);
  world.log("physics: a " + (p_object != nullptr ? p_object->getType() : "body") + " is frozen: " + why);
}

}  // namespace df
