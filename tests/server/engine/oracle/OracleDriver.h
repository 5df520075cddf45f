// Runs a random world in the oracle.
#pragma once

#include "Actor.h"
#include "Oracle.h"
#include "Script.h"

namespace oracle {

class OracleDriver : public Actor, private Handlers {
 public:
  /// `world` must outlive the driver.
  explicit OracleDriver(const RandomWorld& world);

  Script& script() { return m_script; }
  const Counters& counters() const { return m_world.counters(); }

  void create(int id, const Spec& spec) override;
  void markForDelete(int id) override { m_world.markForDelete(object(id)); }
  void deleteByHand(int id) override { m_world.destroy(object(id)); }
  void remove(int id) override { m_world.remove(object(id)); }
  void insert(int id) override { m_objects[static_cast<std::size_t>(id)] = m_world.insert(object(id)); }
  int moveObject(int id, FixedVector where) override;
  void setPosition(int id, FixedVector position) override;
  void setVelocity(int id, FixedVector velocity) override { object(id)->velocity = velocity; }
  void setAcceleration(int id, FixedVector acceleration) override { object(id)->acceleration = acceleration; }
  void setSolidness(int id, Solidness solidness) override { object(id)->solidness = solidness; }
  void setBox(int id, FixedBox box) override { object(id)->box = box; }
  void setNoSoft(int id, bool no_soft) override { object(id)->no_soft = no_soft; }
  void setActive(int id, bool active) override { object(id)->active = active; }
  void setOptions(int id, Options options) override { object(id)->options = options; }
  void setMask(int id, const Mask& mask) override { object(id)->mask = mask; }
  void setSweptCollisions(bool swept) override { m_world.setSweptCollisions(swept); }
  FixedVector getPosition(int id) const override;
  FixedVector getVelocity(int id) const override { return object(id)->velocity; }
  Solidness getSolidness(int id) const override { return object(id)->solidness; }
  bool getSweptCollisions() const override { return m_world.getSweptCollisions(); }
  Meeting firstContact(int id, FixedVector where) override;
  std::optional<FixedVector> findFree(FixedBox box, FixedVector near) override;
  void tick() override;
  std::vector<Snapshot> snapshot() const override;

 private:
  void step(Object* p_receiver) override;
  void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) override;
  void out(Object* p_receiver) override;
  void destroyed(Object* p_o) override { m_script.onDestroyed(p_o->id); }

  Object* object(int id) const { return m_objects[static_cast<std::size_t>(id)]; }
  bool isDeaf(int id) const { return m_deaf[static_cast<std::size_t>(id)]; }

  World m_world;
  Script m_script;
  std::vector<Object*> m_objects;  ///< index: id
  std::vector<bool> m_deaf;        ///< index: id
};

}  // namespace oracle
