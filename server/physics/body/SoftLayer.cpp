#include "physics/body/SoftLayer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/Object.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyEvents.h"
#include "physics/body/BodyLayer.h"

namespace df {

namespace {

using naiad::physics::Metric;
using naiad::physics::MovedObject;
using naiad::physics::SoftHold;
using naiad::physics::SoftNode;
using naiad::physics::SoftObstacle;
using naiad::physics::SoftPull;
using naiad::physics::SoftSeat;
using naiad::physics::SoftStatus;
using naiad::physics::SoftTable;
using naiad::physics::SoftWorld;
using naiad::physics::Vec2;

constexpr double kRoom = 0.5;            // around a soft body, so that what comes near is seen in time
constexpr double kStillSpeed = 2e-3;     // cells per tick, of what lies or hangs
constexpr double kFloatingSpeed = 1e-6;  // the same of what does not
constexpr int kSinceTouch = 10;          // ticks
constexpr int kStillTicks = 30;          // until it sleeps
constexpr double kStillWay = 0.02;       // what nobody is told of a body that is that slow

bool takesPart(const WorldStore& store, ObjectKey key) {
  constexpr std::uint32_t kNeeded = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kBody;
  return store.isCurrent(key) && (store.flags(key.slot) & kNeeded) == kNeeded;
}

// Around all nodes, with some room, so that it need not follow each of their movements.
FixedBox boxOf(SoftTable& table, int id, FixedVector position, const FixedBox& before) {
  constexpr double kMargin = 0.25, kLargest = 1e6;
  const naiad::physics::SoftBody& body = table.world().body(id);
  const Metric& metric = table.metric();
  const Vector middle = metric.toCells(metric.placeOf(position) - body.place);
  const Vector thick = metric.toCells({body.radius, body.radius});
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  for (const SoftNode& node : body.nodes) {
    const Vector at = metric.toCells(node.offset) - middle;
    left = std::min(left, at.x() - thick.x());
    right = std::max(right, at.x() + thick.x());
    top = std::min(top, at.y() - thick.y());
    bottom = std::max(bottom, at.y() + thick.y());
  }
  const Vector corner = Vector::fromFixed(before.corner), size = Vector::fromFixed(before.size);
  const auto fits = [](double inner, double outer) { return inner >= 0 && outer <= 1 && inner <= 1; };
  const bool is_good = fits(left - corner.x(), 0) && fits(top - corner.y(), 0) &&
                       fits(corner.x() + size.x() - right, 0) && fits(corner.y() + size.y() - bottom, 0);
  if (is_good) return before;
  const auto from = toFixed(Vector(left - kMargin, top - kMargin), kLargest);
  const auto extent = toFixed(Vector(right - left + 2 * kMargin, bottom - top + 2 * kMargin), kLargest);
  return from && extent ? FixedBox{*from, *extent} : before;
}

}  // namespace

SoftLayer& SoftLayer::of(World& world) {
  if (auto* p_layer = world.findLayer<SoftLayer>()) return *p_layer;
  BodyLayer& bodies = BodyLayer::of(world);
  world.addLayer(std::make_unique<SoftLayer>(bodies, bodies.table()));
  return *world.findLayer<SoftLayer>();
}

void SoftLayer::tellAtOnce(World& world, SoftTable& table, int id) {
  SoftSeat& seat = table.seat(id);
  WorldStore& store = world.store();
  if (table.metric().isInRange(seat.centre)) {
    store.setPosition(seat.key.slot, table.metric().fixedOf(seat.centre));
  }
  seat.told_position = store.position(seat.key.slot);
  seat.told_velocity = store.velocity(seat.key.slot);
  store.setBox(seat.key.slot, boxOf(table, id, seat.told_position, store.box(seat.key.slot)));
}

void SoftLayer::step(World& world) {
  SoftTable& table = *m_table;
  SoftWorld& soft = table.world();
  m_moved.clear();
  m_news.clear();
  m_meetings.begin();
  m_reaches.assign(static_cast<std::size_t>(table.idLimit()), {});
  m_rests.assign(static_cast<std::size_t>(table.idLimit()), 0);
  if (m_gravity != table.bodies().gravity && soft.setGravity(table.bodies().gravity)) {
    m_gravity = table.bodies().gravity;
    for (int id = 0; id < table.idLimit(); ++id) table.wake(id);
  }
  for (int id = 0; id < table.idLimit(); ++id) prepare(world, id);
  wakeByOthers();
  for (int id = 0; id < table.idLimit(); ++id) {
    SoftSeat& seat = table.seat(id);
    if (seat.is_in && !seat.is_asleep) push(id);
    if (seat.p_object != nullptr) soft.setOut(id, !seat.is_in || seat.is_asleep);
  }
  soft.step(1, m_meetings.obstacles());
  tellOfCrowd(world);
  m_touches.collect(world.store(), table, m_meetings, m_news);
  findLoads();
  m_meetings.apply(world, m_bodies, table, m_moved);
  for (int id = 0; id < table.idLimit(); ++id) {
    if (table.seat(id).is_in && !table.seat(id).is_asleep) settle(world, id);
  }
  rest();
  // Only now do handlers run.
  for (const MovedObject& moved : m_moved) {
    if (takesPart(world.store(), moved.key)) world.place(moved.key, moved.where);
  }
  if (!m_news.empty()) tellContacts(world, m_news);
}

// Once: it counts on in SoftCounters::crowded.
void SoftLayer::tellOfCrowd(World& world) {
  if (m_has_told_of_crowd || m_table->world().counters().crowded == 0) return;
  m_has_told_of_crowd = true;
  world.log("physics: too many soft bodies in one place: some pass through one another until there is room");
}

// Does it take part, and what is around it?
void SoftLayer::prepare(const World& world, int id) {
  SoftSeat& seat = m_table->seat(id);
  seat.is_in = false;
  if (seat.p_object == nullptr) return;
  const WorldStore& store = world.store();
  if (!store.isCurrent(seat.key)) seat.key = seat.p_object->key();  // removed; perhaps inserted again
  if (!takesPart(store, seat.key)) return;
  m_table->absorb(id, store.position(seat.key.slot), store.velocity(seat.key.slot));
  std::erase_if(seat.holds, [&](const SoftHold& hold) {
    if (store.isCurrent(hold.key)) return false;
    m_table->world().detach(hold.attachment);
    m_table->wake(id);
    return true;
  });
  if (seat.is_frozen) return;
  seat.is_in = true;
  double gravity = length(m_gravity) * std::fabs(seat.gravity_scale) + length(seat.force) / seat.mass;
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  for (const SoftPull& pull : seat.pulls) {
    gravity += length(pull.force) / nodes[static_cast<std::size_t>(pull.node)].mass;
  }
  const double far = kRoom + seat.top_speed + gravity;
  const Vec2 reach = m_table->reach(id) + Vec2{far, far};
  m_reaches[static_cast<std::size_t>(id)] = reach;
  m_meetings.gather(world, m_bodies, *m_table, id, reach);
  if (seat.is_asleep && m_meetings.surrounding() != seat.surrounding) m_table->wake(id);
  seat.surrounding = m_meetings.surrounding();
  m_meetings.addHand(*m_table, seat, id);
}

bool SoftLayer::areNear(int a, int b) {
  const Vec2 way = m_table->seat(a).centre - m_table->seat(b).centre;
  const Vec2 reach = m_reaches[static_cast<std::size_t>(a)] + m_reaches[static_cast<std::size_t>(b)];
  return std::fabs(way.x) <= reach.x && std::fabs(way.y) <= reach.y;
}

// Who sleeps beside somebody who is awake, and not about to sleep himself, is awake.
void SoftLayer::wakeByOthers() {
  SoftTable& table = *m_table;
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (int id = 0; id < table.idLimit(); ++id) {
      if (!table.seat(id).is_in || !table.seat(id).is_asleep) continue;
      for (int other = 0; other < table.idLimit(); ++other) {
        if (other == id || !table.seat(other).is_in || table.seat(other).is_asleep || !areNear(id, other)) {
          continue;
        }
        table.wake(id);
        is_changed = true;
        break;
      }
    }
  }
}

// Gravity is the world's; what differs from it pulls at the nodes.
void SoftLayer::push(int id) {
  SoftSeat& seat = m_table->seat(id);
  const Vec2 acceleration = (seat.gravity_scale - 1) * m_gravity + seat.force / seat.mass;
  seat.force = {};
  const bool pulls = acceleration != Vec2{} || !seat.pulls.empty();
  if (!pulls && !seat.has_forces) return;
  seat.has_forces = pulls;
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vec2 force = nodes[i].mass * acceleration;
    for (const SoftPull& pull : seat.pulls) {
      if (static_cast<std::size_t>(pull.node) == i) force += pull.force;
    }
    // As a whole, once: a force that changes makes the solver forget the past.
    m_table->world().setForce(id, static_cast<int>(i), force);
  }
  seat.pulls.clear();
}

void SoftLayer::settle(World& world, int id) {
  if (m_table->world().isFrozen(id)) return freeze(world, id);
  m_table->measure(id);
  const SoftSeat& seat = m_table->seat(id);
  const auto velocity = toFixed(m_table->metric().toCells(seat.velocity), kMaxVelocityCells);
  if (!velocity || !m_table->metric().isInRange(seat.centre)) return freeze(world, id);
  tell(world, id);
}

// It stands, so that nothing of it spreads.
void SoftLayer::freeze(World& world, int id) {
  SoftSeat& seat = m_table->seat(id);
  ++m_table->bodies().counters.quarantined;
  seat.is_frozen = true;
  seat.is_in = false;
  seat.velocity = {};
  seat.told_velocity = {};
  world.store().setVelocity(seat.key.slot, {});
  world.store().setAcceleration(seat.key.slot, {});
  m_table->world().setOut(id, true);
  const Object* p_object = world.find(seat.key);
  world.log("physics: a " + (p_object != nullptr ? p_object->getType() : "soft body") +
            " is frozen: its motion cannot be worked out");
}

void SoftLayer::tell(World& world, int id) {
  SoftSeat& seat = m_table->seat(id);
  WorldStore& store = world.store();
  const Metric& metric = m_table->metric();
  const FixedVector position = metric.fixedOf(seat.centre);
  const Vector moved = metric.toCells(seat.centre - metric.placeOf(seat.told_position));
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  const bool is_held = seat.hand.attachment >= 0 || !seat.holds.empty() ||
                       std::any_of(nodes.begin(), nodes.end(), [](const SoftNode& n) { return n.is_pinned; });
  seat.since_touch = m_table->world().isTouching(id) ? 0 : seat.since_touch + 1;
  const bool is_carried = is_held || seat.since_touch < kSinceTouch;
  const bool is_slow = seat.top_speed < (is_carried ? kStillSpeed : kFloatingSpeed);
  seat.still = is_slow ? seat.still + 1 : 0;
  const bool is_calm = is_slow && std::fabs(moved.x()) < kStillWay && std::fabs(moved.y()) < kStillWay;
  if (!is_calm) seat.told_position = position;
  seat.told_velocity =
      is_slow ? FixedVector{}
              : toFixed(metric.toCells(seat.velocity), kMaxVelocityCells).value_or(FixedVector{});
  const bool is_free = !is_slow && !is_held && seat.since_touch > 0;
  const Vec2 gravity = is_free ? seat.gravity_scale * m_gravity : Vec2{};
  store.setVelocity(seat.key.slot, seat.told_velocity);
  store.setAcceleration(seat.key.slot,
                        toFixed(metric.toCells(gravity), kMaxVelocityCells).value_or(FixedVector{}));
  store.set(seat.key.slot, WorldStore::kDerive, true);
  const FixedBox before = store.box(seat.key.slot);
  const FixedBox box = boxOf(*m_table, id, seat.told_position, before);
  if (!(box == before)) store.setBox(seat.key.slot, box);
  if (seat.told_position != store.position(seat.key.slot)) m_moved.push_back({seat.key, seat.told_position});
}

bool SoftLayer::mayRest(int id) const {
  const SoftSeat& seat = m_table->seat(id);
  return seat.is_in &&
         (seat.is_asleep || (seat.still >= kStillTicks && !seat.is_loaded && seat.holds.empty() &&
                             seat.hand.attachment < 0 && seat.surrounding != 0));
}

// Neighbours fall asleep together, or not at all.
void SoftLayer::rest() {
  SoftTable& table = *m_table;
  for (int id = 0; id < table.idLimit(); ++id) m_rests[static_cast<std::size_t>(id)] = mayRest(id) ? 1 : 0;
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (int id = 0; id < table.idLimit(); ++id) {
      char& rests = m_rests[static_cast<std::size_t>(id)];
      for (int other = 0; other < table.idLimit() && rests != 0; ++other) {
        const bool keeps_up = other != id && table.seat(other).is_in &&
                              m_rests[static_cast<std::size_t>(other)] == 0 && areNear(id, other);
        if (!keeps_up) continue;
        rests = 0;
        is_changed = true;
      }
    }
  }
  for (int id = 0; id < table.idLimit(); ++id) {
    SoftSeat& seat = table.seat(id);
    if (m_rests[static_cast<std::size_t>(id)] == 0 || seat.is_asleep) continue;
    naiad::physics::SoftBody body = table.world().body(id);
    for (SoftNode& node : body.nodes) node.velocity = {};
    table.set(id, body);
    table.measure(id);
    seat.is_asleep = true;
  }
}

// On whom does something press that could move?
void SoftLayer::findLoads() {
  for (int id = 0; id < m_table->idLimit(); ++id) m_table->seat(id).is_loaded = false;
  for (const SoftObstacle& obstacle : m_meetings.obstacles()) {
    if (obstacle.inverse_mass == 0 || obstacle.impulse == Vec2{}) continue;
    for (int id = 0; id < m_table->idLimit(); ++id) {
      SoftSeat& seat = m_table->seat(id);
      seat.is_loaded = seat.is_loaded || m_table->world().isTouching(id, obstacle.id);
    }
  }
}

}  // namespace df
