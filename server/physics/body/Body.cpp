#include "physics/body/Body.h"

#include <cmath>
#include <utility>

#include "engine/world/ClassName.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/BodyLimits.h"
#include "physics/body/Field.h"

namespace df {

namespace {

using naiad::physics::BodyMedium;
using naiad::physics::BodyRow;
using naiad::physics::Vec2;

constexpr double kMinMass = 1e-30;  // the inverse of this mass is kMaxBodyNumber

}  // namespace

Body::Body()
    : m_table(naiad::physics::BodyLayer::of(*getWorld()).table()), m_index(m_table->add(this, key())) {
  WorldStore& store = getWorld()->store();
  store.set(key().slot, WorldStore::kBody, true);
  BodyRow& mine = row();
  mine.published_position = store.position(key().slot);
  mine.published_velocity = store.velocity(key().slot);
  mine.place = m_table->metric.placeOf(mine.published_position);
}

Body::~Body() {
  m_table->remove(m_index);
}

BodyRow& Body::row() const {
  return m_table->row(m_index);
}

int Body::refuseAs(const char* what) const {
  const World* p_world = getWorld();
  return p_world != nullptr ? p_world->log().refuse(nameOf(*this), what) : -1;
}

void Body::syncFromStore() const {
  if (World* p_world = getWorld()) {  // from the store, because a Vector is not exact far from the origin
    const std::uint32_t slot = key().slot;
    return m_table->syncFromStore(m_index, p_world->store().position(slot), p_world->store().velocity(slot));
  }
  const auto position = toFixed(Object::getPosition());
  const auto velocity = toFixed(Object::getVelocity(), kMaxVelocityCells);
  m_table->syncFromStore(m_index, position.value_or(row().published_position),
                         velocity.value_or(row().published_velocity));
}

int Body::setMass(double mass) {
  if (!(mass >= kMinMass && mass <= kMaxBodyNumber)) return refuseAs("setMass");
  row().mass = mass;
  row().inverse_mass = row().is_kinematic ? 0 : 1 / mass;
  m_table->joints.markChanged();
  return 0;
}

double Body::getMass() const {
  return row().mass;
}

int Body::setGravityScale(double scale) {
  if (!isUsable(scale)) return refuseAs("setGravityScale");
  row().gravity_scale = scale;
  return 0;
}

double Body::getGravityScale() const {
  return row().gravity_scale;
}

void Body::setKinematic(bool kinematic) {
  row().is_kinematic = kinematic;
  row().inverse_mass = kinematic ? 0 : 1 / row().mass;
  m_table->joints.markChanged();
}

bool Body::isKinematic() const {
  return row().is_kinematic;
}

int Body::setRestitution(double restitution) {
  if (!(restitution >= 0 && restitution <= 1)) return refuseAs("setRestitution");
  row().restitution = restitution;
  return 0;
}

double Body::getRestitution() const {
  return row().restitution;
}

int Body::setFriction(double friction) {
  if (!isUsableSize(friction)) return refuseAs("setFriction");
  row().friction = friction;
  return 0;
}

double Body::getFriction() const {
  return row().friction;
}

void Body::setContactEnds(bool contact_ends) {
  row().hears_ends = contact_ends;
}

bool Body::hasContactEnds() const {
  return row().hears_ends;
}

int Body::setPosition(Vector position) {
  if (Object::setPosition(position) != 0) return -1;
  BodyRow& mine = row();
  mine.place = m_table->metric.placeAtCells(position);
  mine.published_position = *toFixed(position);
  mine.frozen = false;
  return 0;
}

Vector Body::getPosition() const {
  syncFromStore();
  return m_table->metric.cellsOf(row().place);
}

Vector Body::getDisplacementFrom(Vector point) const {
  if (!toFixed(point)) return {};
  syncFromStore();
  return m_table->metric.toCells(row().place - m_table->metric.placeAtCells(point));
}

int Body::setVelocity(Vector velocity) {
  if (Object::setVelocity(velocity) != 0) return -1;
  BodyRow& mine = row();
  mine.velocity = m_table->metric.fromCells(velocity);
  mine.published_velocity = *toFixed(velocity, kMaxVelocityCells);
  mine.frozen = false;
  return 0;
}

Vector Body::getVelocity() const {
  syncFromStore();
  return m_table->metric.toCells(row().velocity);
}

int Body::applyForce(Vector force) {
  const Vector sum = m_table->metric.toCells(row().force) + force;
  if (!isUsable(force) || !isUsable(sum)) return refuseAs("applyForce");
  row().force = m_table->metric.fromCells(sum);
  return 0;
}

int Body::applyImpulse(Vector impulse) {
  syncFromStore();
  const Vector change = m_table->metric.toCells(row().inverse_mass * m_table->metric.fromCells(impulse));
  const Vector velocity = getVelocity() + change;
  if (!isUsable(impulse) || !toFixed(velocity, kMaxVelocityCells)) return refuseAs("applyImpulse");
  return setVelocity(velocity);
}

int Body::setDrag(double linear, double quadratic) {
  if (!isUsableSize(linear) || !isUsableSize(quadratic)) return refuseAs("setDrag");
  BodyMedium& medium = m_table->medium(m_index);
  medium.linear_drag = linear;
  medium.quadratic_drag = quadratic;
  m_table->classify(m_index);
  return 0;
}

int Body::setSpring(Vector anchor, double stiffness, double damping) {
  const bool good = toFixed(anchor) && isUsableSize(stiffness) && isUsableSize(damping);
  if (!good) return refuseAs("setSpring");
  BodyMedium& medium = m_table->medium(m_index);
  medium.anchor = m_table->metric.placeAtCells(anchor);
  medium.spring = {stiffness, damping};
  m_table->classify(m_index);
  return 0;
}

int Body::setField(const Field* p_field, Vector origin) {
  if (!toFixed(origin)) return refuseAs("setField");
  BodyMedium& medium = m_table->medium(m_index);
  medium.field = p_field != nullptr ? p_field->m_forces.get() : nullptr;
  medium.field_origin = m_table->metric.placeAtCells(origin);
  m_table->classify(m_index);
  return 0;
}

bool Body::isFrozen() const {
  syncFromStore();
  return row().frozen;
}

}  // namespace df
