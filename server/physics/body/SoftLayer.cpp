#include "physics/body/SoftLayer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/EventDispatch.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyEvents.h"
#include "physics/body/BodyLayer.h"

namespace naiad::physics {

namespace {

constexpr double kSearchRoom = 0.5;      // metric cells around a soft body, searched for obstacles
constexpr double kStillSpeed = 2e-3;     // metric cells per tick: slower lying or hanging bodies are still
constexpr double kFloatingSpeed = 1e-6;  // like kStillSpeed, for floating bodies, which no contact stops
constexpr int kSinceTouch = 10;          // ticks after a touch for which a body counts as lying
constexpr double kStillDistance = 0.02;  // cells: if a still body moves less, this is not published

// Returns a box around all nodes: `before` if it still fits. The margin avoids a new box for small movements.
FixedBox boxOf(SoftTable& table, int id, FixedVector position, const FixedBox& before) {
  constexpr double kMargin = 0.25, kLargest = 1e6;  // cells: margin around the nodes, maximum size of the box
  const SoftBody& body = table.world().body(id);
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

void SoftLayer::publishNow(World& world, SoftTable& table, int id) {
  SoftEntry& entry = table.entry(id);
  WorldStore& store = world.store();
  if (table.metric().isInRange(entry.centre)) {
    store.setPosition(entry.key.slot, table.metric().fixedOf(entry.centre));
  }
  entry.published_position = store.position(entry.key.slot);
  entry.published_velocity = store.velocity(entry.key.slot);
  store.setBox(entry.key.slot, boxOf(table, id, entry.published_position, store.box(entry.key.slot)));
}

void SoftLayer::step(World& world) {
  SoftTable& table = *m_table;
  SoftWorld& soft = table.world();
  m_moved.clear();
  m_contact_changes.clear();
  m_obstacles.clear();
  m_sleep.begin(table.idLimit());
  if (m_gravity != table.bodies().settings.gravity && soft.setGravity(table.bodies().settings.gravity)) {
    m_gravity = table.bodies().settings.gravity;
    for (int id = 0; id < table.idLimit(); ++id) table.wake(id);
  }
  for (int id = 0; id < table.idLimit(); ++id) prepare(world, id);
  m_sleep.wakeNeighbours(table);
  for (int id = 0; id < table.idLimit(); ++id) {
    SoftEntry& entry = table.entry(id);
    if (entry.is_in && !entry.is_asleep) setForces(id);
    if (entry.p_object != nullptr) soft.setOut(id, !entry.is_in || entry.is_asleep);
  }
  soft.step(1, m_obstacles.all());
  logCrowd(world);
  collectContacts(world.store());
  m_sleep.findLoads(table, m_obstacles.all());
  m_obstacles.apply(world, m_bodies, table, m_moved);
  for (int id = 0; id < table.idLimit(); ++id) {
    if (table.entry(id).is_in && !table.entry(id).is_asleep) settle(world, id);
  }
  m_sleep.update(table);
  placeMoved(world, m_moved);
  send(world);
  endMarked(world);
}

void SoftLayer::send(World& world) {
  if (m_contact_changes.empty() || !sendContactEvents(world, m_contact_changes)) return;
  for (const BodyContact& contact : m_contact_changes) {
    for (Touch& touch : m_touching) {
      const bool is_its = touch.contact.first == contact.first && touch.contact.second == contact.second;
      if (is_its && contact.is_begin) touch.contact.missed = contact.missed;
    }
  }
}

// Ends the contacts of the Objects for which `isOver` is true.
template <class IsOver>
void SoftLayer::endContacts(IsOver isOver) {
  std::erase_if(m_touching, [&](const Touch& touch) {
    if (!isOver(touch.contact.first) && !isOver(touch.contact.second)) return false;
    m_contact_changes.push_back(touch.contact);
    m_contact_changes.back().is_begin = false;
    m_contact_changes.back().impulse = 0;
    return true;
  });
}

// Ends the contacts of the Objects that are marked for deletion, also those of the layer of bodies.
void SoftLayer::endMarked(World& world) {
  const WorldStore& store = world.store();
  const std::vector<ObjectKey>& marked = world.objects().marked();
  for (std::size_t known = 0; known < marked.size();) {
    known = marked.size();
    m_contact_changes.clear();
    endContacts(
        [&](ObjectKey key) { return store.isCurrent(key) && store.has(key.slot, WorldStore::kMarked); });
    send(world);
    m_bodies.endMarked(world);
  }
}

// Converts the solver's events to contacts of Objects. An end has the Objects of its begin, even if the
// obstacle is no longer near.
void SoftLayer::collectContacts(const WorldStore& store) {
  endContacts([&](ObjectKey key) { return !store.isCurrent(key); });
  for (const SoftEvent& event : m_table->world().events()) {
    const auto touch = std::find_if(m_touching.begin(), m_touching.end(), [&](const Touch& t) {
      return t.body == event.body && t.other == event.other && t.is_other_soft == event.is_other_soft;
    });
    const bool is_known = touch != m_touching.end();
    if (!event.is_begin && !is_known) continue;
    BodyContact contact;
    if (event.is_begin) {
      contact.first = m_table->entry(event.body).key;
      contact.second = event.is_other_soft ? m_table->entry(event.other).key : m_obstacles.keyOf(event.other);
      if (!store.isCurrent(contact.first) || !store.isCurrent(contact.second)) continue;
      contact.time = 1;
      contact.first_order = store.order(contact.first.slot);
      contact.second_order = store.order(contact.second.slot);
      m_touching.push_back({contact, event.body, event.other, event.is_other_soft});
    } else {
      contact = touch->contact;
      m_touching.erase(touch);
    }
    contact.impulse = event.impulse;
    contact.is_begin = event.is_begin;
    m_contact_changes.push_back(contact);
  }
}

// Logs only the first case; SoftCounters::crowded counts all of them.
void SoftLayer::logCrowd(World& world) {
  if (m_has_logged_crowd || m_table->world().counters().crowded == 0) return;
  m_has_logged_crowd = true;
  world.log().write(
      "physics: too many soft bodies in one place: some pass through others until there is room");
}

// Decides whether the body takes part, and gathers the obstacles around it.
void SoftLayer::prepare(const World& world, int id) {
  SoftEntry& entry = m_table->entry(id);
  entry.is_in = false;
  if (entry.p_object == nullptr) return;
  const WorldStore& store = world.store();
  if (!store.isCurrent(entry.key)) entry.key = entry.p_object->key();  // removed; perhaps inserted again
  if (!takesPart(store, entry.key)) return;
  m_table->syncFromStore(id, store.position(entry.key.slot), store.velocity(entry.key.slot));
  std::erase_if(entry.attached_nodes, [&](const SoftAttachedNode& attached) {
    if (store.isCurrent(attached.key)) return false;
    m_table->world().detach(attached.attachment);
    m_table->wake(id);
    return true;
  });
  if (entry.is_frozen) return;
  entry.is_in = true;
  double gravity = length(m_gravity) * std::fabs(entry.gravity_scale) + length(entry.force) / entry.mass;
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  for (std::size_t i = 0; i < entry.node_forces.size(); ++i) {
    gravity += length(entry.node_forces[i]) / nodes[i].mass;
  }
  const double far = kSearchRoom + entry.top_speed + gravity;
  const Vec2 reach = m_table->reach(id) + Vec2{far, far};
  m_sleep.setReach(id, reach);
  m_obstacles.gather(world, m_bodies, *m_table, id, reach);
  if (entry.is_asleep && m_obstacles.surrounding() != entry.surrounding) m_table->wake(id);
  entry.surrounding = m_obstacles.surrounding();
  m_obstacles.addGrab(*m_table, entry, id);
}

// Sets the forces on the nodes. The solver applies the world's gravity, so only the difference is added.
void SoftLayer::setForces(int id) {
  SoftEntry& entry = m_table->entry(id);
  const Vec2 acceleration = (entry.gravity_scale - 1) * m_gravity + entry.force / entry.mass;
  entry.force = {};
  const bool pulls = acceleration != Vec2{} || !entry.node_forces.empty();
  if (!pulls && !entry.has_forces) return;
  entry.has_forces = pulls;
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    Vec2 force = nodes[i].mass * acceleration;
    if (!entry.node_forces.empty()) force += entry.node_forces[i];
    // Sets the sum in one call, because the solver drops its history when a force changes.
    m_table->world().setForce(id, static_cast<int>(i), force);
  }
  entry.node_forces.clear();
}

void SoftLayer::settle(World& world, int id) {
  if (m_table->world().isFrozen(id)) return freeze(world, id);
  m_table->measure(id);
  const SoftEntry& entry = m_table->entry(id);
  const auto velocity = toFixed(m_table->metric().toCells(entry.velocity), kMaxVelocityCells);
  if (!velocity || !m_table->metric().isInRange(entry.centre)) return freeze(world, id);
  publish(world, id);
}

// Freezes the body, so that its invalid numbers do not spread to other bodies.
void SoftLayer::freeze(World& world, int id) {
  SoftEntry& entry = m_table->entry(id);
  ++m_table->bodies().counters.quarantined;
  entry.is_frozen = true;
  entry.is_in = false;
  entry.velocity = {};
  entry.published_velocity = {};
  world.store().setVelocity(entry.key.slot, {});
  world.store().setAcceleration(entry.key.slot, {});
  m_table->world().setOut(id, true);
  const Object* p_object = world.store().find(entry.key);
  world.log().write("physics: a " + (p_object != nullptr ? p_object->getType() : "soft body") +
                    " is frozen: its motion cannot be computed");
}

void SoftLayer::publish(World& world, int id) {
  SoftEntry& entry = m_table->entry(id);
  WorldStore& store = world.store();
  const Metric& metric = m_table->metric();
  const FixedVector position = metric.fixedOf(entry.centre);
  const Vector moved = metric.toCells(entry.centre - metric.placeOf(entry.published_position));
  const std::vector<SoftNode>& nodes = m_table->world().body(id).nodes;
  const bool is_held = entry.grab.attachment >= 0 || !entry.attached_nodes.empty() ||
                       std::any_of(nodes.begin(), nodes.end(), [](const SoftNode& n) { return n.is_pinned; });
  entry.since_touch = m_table->world().isTouching(id) ? 0 : entry.since_touch + 1;
  const bool is_carried = is_held || entry.since_touch < kSinceTouch;
  const bool is_slow = entry.top_speed < (is_carried ? kStillSpeed : kFloatingSpeed);
  entry.still = is_slow ? entry.still + 1 : 0;
  const bool is_calm =
      is_slow && std::fabs(moved.x()) < kStillDistance && std::fabs(moved.y()) < kStillDistance;
  if (!is_calm) entry.published_position = position;
  entry.published_velocity =
      is_slow ? FixedVector{}
              : toFixed(metric.toCells(entry.velocity), kMaxVelocityCells).value_or(FixedVector{});
  const bool is_free = !is_slow && !is_held && entry.since_touch > 0;
  const Vec2 gravity = is_free ? entry.gravity_scale * m_gravity : Vec2{};
  store.setVelocity(entry.key.slot, entry.published_velocity);
  store.setAcceleration(entry.key.slot,
                        toFixed(metric.toCells(gravity), kMaxVelocityCells).value_or(FixedVector{}));
  store.set(entry.key.slot, WorldStore::kDerive, true);
  const FixedBox before = store.box(entry.key.slot);
  const FixedBox box = boxOf(*m_table, id, entry.published_position, before);
  if (!(box == before)) store.setBox(entry.key.slot, box);
  if (entry.published_position != store.position(entry.key.slot))
    m_moved.push_back({entry.key, entry.published_position});
}

}  // namespace naiad::physics
