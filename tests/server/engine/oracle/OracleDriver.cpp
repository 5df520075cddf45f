#include "OracleDriver.h"

namespace oracle {

// Rounds a position to doubles, which games and scripts use. Beyond 2^21 cells, this changes its last digits.
static FixedVector inDoubles(FixedVector position) {
  return {*df::toFixed(df::toCells(position.x)), *df::toFixed(df::toCells(position.y))};
}

OracleDriver::OracleDriver(const RandomWorld& world)
    : m_world(world.boundary, static_cast<Handlers&>(*this)), m_script(world, *this) {
  m_script.begin();
}

void OracleDriver::create(int id, const Spec& spec) {
  Object* p_o = m_world.create(id);
  m_objects.push_back(p_o);
  m_deaf.push_back(spec.temper == Temper::DEAF);
  static_cast<State&>(*p_o) = spec;
  p_o->position = inDoubles(spec.position);
  p_o->acceleration = spec.acceleration;
  p_o->mask = spec.mask;
}

int OracleDriver::moveObject(int id, FixedVector where) {
  return m_world.moveObject(object(id), inDoubles(where));
}

void OracleDriver::setPosition(int id, FixedVector position) {
  object(id)->position = inDoubles(position);
}

FixedVector OracleDriver::getPosition(int id) const {
  return inDoubles(object(id)->position);
}

Meeting OracleDriver::firstContact(int id, FixedVector where) {
  const Contact contact = m_world.firstContact(object(id), inDoubles(where));
  return {contact.p_object != nullptr ? contact.p_object->id : -1, contact.time.toDouble(),
          inDoubles(contact.position)};
}

std::optional<FixedVector> OracleDriver::findFree(FixedBox box, FixedVector near) {
  const auto found = m_world.findFree(box, inDoubles(near));
  return found ? std::optional(inDoubles(*found)) : std::nullopt;
}

void OracleDriver::step(Object* p_receiver) {
  if (!isDeaf(p_receiver->id)) m_script.onStep(p_receiver->id);
}

void OracleDriver::collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) {
  if (!isDeaf(p_receiver->id)) m_script.onCollision(p_receiver->id, p_obj1->id, p_obj2->id, inDoubles(where));
}

void OracleDriver::out(Object* p_receiver) {
  if (!isDeaf(p_receiver->id)) m_script.onOut(p_receiver->id);
}

void OracleDriver::tick() {
  m_script.beginTick();
  m_world.step();
  m_world.update();
}

std::vector<Snapshot> OracleDriver::snapshot() const {
  std::vector<Snapshot> result;
  for (const Object* p_o : m_world.getAllObjects()) {
    result.push_back({*p_o, p_o->id});
    result.back().position = inDoubles(p_o->position);
  }
  return result;
}

}  // namespace oracle
