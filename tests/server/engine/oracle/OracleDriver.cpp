#include "OracleDriver.h"

namespace oracle {

OracleDriver::OracleDriver(const RandomWorld& world)
    : m_world(world.boundary, static_cast<Handlers&>(*this)), m_script(world, *this) {
  m_script.begin();
}

void OracleDriver::create(int id, const Spec& spec) {
  Object* p_o = m_world.create(id);
  m_objects.push_back(p_o);
  p_o->position = spec.position;
  setVelocity(id, spec.velocity);
  p_o->acceleration = spec.acceleration;
  p_o->box = spec.box;
  p_o->solidness = spec.solidness;
  p_o->no_soft = spec.no_soft;
  p_o->active = spec.active;
}

void OracleDriver::tick() {
  m_script.beginTick();
  m_world.step();
  m_world.update();
}

std::vector<Snapshot> OracleDriver::snapshot() const {
  std::vector<Snapshot> result;
  for (const Object* p_o : m_world.getAllObjects()) {
    result.push_back(
        {p_o->id, p_o->position, p_o->velocity, p_o->box, p_o->solidness, p_o->no_soft, p_o->active});
  }
  return result;
}

}  // namespace oracle
