// Runs a random world in the engine.
#pragma once

#include "Actor.h"
#include "Script.h"
#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace oracle {

class EngineDriver : public Actor {
 public:
  /// `world` must outlive the driver.
  explicit EngineDriver(const RandomWorld& world);
  ~EngineDriver() override;

  Script& script() { return m_script; }
  /// Returns how many calls the engine refused because of a number. The script makes no such calls.
  std::uint64_t refusals() const { return m_world.log().refusals(); }

  void create(int id, const Spec& spec) override;
  void markForDelete(int id) override;
  void deleteByHand(int id) override;
  void remove(int id) override;
  void insert(int id) override;
  int moveObject(int id, FixedVector where) override;
  void setPosition(int id, FixedVector position) override;
  void setVelocity(int id, FixedVector velocity) override;
  void setAcceleration(int id, FixedVector acceleration) override;
  void setSolidness(int id, Solidness solidness) override;
  void setBox(int id, FixedBox box) override;
  void setNoSoft(int id, bool no_soft) override;
  void setActive(int id, bool active) override;
  void setOptions(int id, Options options) override;
  void setMask(int id, const Mask& mask) override;
  void setSweptCollisions(bool swept) override;
  FixedVector getPosition(int id) const override;
  FixedVector getVelocity(int id) const override;
  Solidness getSolidness(int id) const override;
  bool getSweptCollisions() const override;
  Meeting firstContact(int id, FixedVector where) override;
  std::optional<FixedVector> findFree(FixedBox box, FixedVector near) override;
  const df::MoverStats& moverStats() const { return m_world.store().grid().moverStats(); }
  void tick() override;
  std::vector<Snapshot> snapshot() const override;

 private:
  class Numbered;
  class Scripted;

  Numbered* object(int id) const { return m_objects[static_cast<std::size_t>(id)]; }

  df::World m_world;
  df::World::Scope m_scope;
  Script m_script;
  std::vector<Numbered*> m_objects;  ///< index: id; null once destroyed
};

}  // namespace oracle
