// Runs a random world in the engine.
#pragma once

#include "Actor.h"
#include "Script.h"
#include "engine/managers/WorldManager.h"
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
  void markForDelete(int id) override { WM.markForDelete(object(id)); }
  void deleteByHand(int id) override { delete object(id); }
  void remove(int id) override { WM.removeObject(object(id)); }
  void insert(int id) override;
  int moveObject(int id, FixedVector where) override { return WM.moveObject(object(id), inCells(where)); }
  void setPosition(int id, FixedVector position) override { object(id)->setPosition(inCells(position)); }
  void setVelocity(int id, FixedVector velocity) override { object(id)->setVelocity(inCells(velocity)); }
  void setAcceleration(int id, FixedVector acceleration) override {
    object(id)->setAcceleration(inCells(acceleration));
  }
  void setSolidness(int id, Solidness solidness) override { object(id)->setSolidness(solidness); }
  void setBox(int id, FixedBox box) override { object(id)->setBox(df::fromFixed(box)); }
  void setNoSoft(int id, bool no_soft) override { object(id)->setNoSoft(no_soft); }
  void setActive(int id, bool active) override { object(id)->setActive(active); }
  void setOptions(int id, Options options) override;
  void setMask(int id, const Mask& mask) override;
  void setSweptCollisions(bool swept) override { WM.setSweptCollisions(swept); }
  FixedVector getPosition(int id) const override { return *df::toFixed(object(id)->getPosition()); }
  FixedVector getVelocity(int id) const override { return *df::toFixed(object(id)->getVelocity()); }
  Solidness getSolidness(int id) const override { return object(id)->getSolidness(); }
  bool getSweptCollisions() const override { return WM.getSweptCollisions(); }
  Meeting firstContact(int id, FixedVector where) override;
  std::optional<FixedVector> findFree(FixedBox box, FixedVector near) override;
  const df::MoverStats& moverStats() const { return m_world.store().grid().moverStats(); }
  void tick() override;
  std::vector<Snapshot> snapshot() const override;

 private:
  class Numbered;
  class Scripted;

  static df::Vector inCells(FixedVector v) { return df::Vector::fromFixed(v); }
  df::Object* object(int id) const { return m_objects[static_cast<std::size_t>(id)]; }

  df::World m_world;
  df::World::Scope m_scope;
  Script m_script;
  std::vector<df::Object*> m_objects;  ///< index: id; null once destroyed
};

}  // namespace oracle
