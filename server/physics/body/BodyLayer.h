// The physics' part of a world's update(): steps all bodies by one tick.
//
// A world gets this layer with its first Body or its first PM.set… call; before that, it costs nothing. In
// each tick BodyIslands chooses the solver of each body: its own flight if nothing can touch it, an
// ImpactWorld, a RigidWorld or a SubstepWorld.
#pragma once

#include <memory>
#include <vector>

#include "engine/world/Layer.h"
#include "engine/world/WorldStore.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyImpacts.h"
#include "physics/body/BodyIslands.h"
#include "physics/body/BodyLinks.h"
#include "physics/body/BodyPlatforms.h"
#include "physics/body/BodyRigids.h"
#include "physics/body/BodySensors.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodyTable.h"
#include "physics/rigid/RigidWorld.h"
#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

/// True if the rigid or soft body is in the world, active, and not about to be deleted.
inline bool takesPart(const WorldStore& store, ObjectKey key) {
  constexpr std::uint32_t kNeeded = WorldStore::kInWorld | WorldStore::kActive | WorldStore::kBody;
  return store.isCurrent(key) && (store.flags(key.slot) & kNeeded) == kNeeded;
}

/// Sets the new positions of these Objects in the world, after all bodies have moved. Runs handlers.
void placeMoved(World& world, const std::vector<MovedObject>& all);

class BodyLayer : public df::Layer {
 public:
  BodyLayer() : m_table(std::make_shared<BodyTable>()) {}
  /// Returns the layer of this world; creates it if needed.
  static BodyLayer& of(World& world);

  void step(World& world) override;
  const std::shared_ptr<BodyTable>& table() { return m_table; }
  /// Returns the states of this tick, for the layers that run after this one.
  const std::vector<BodyState>& states() const { return m_states; }
  /// Ends the contacts of the Objects that are marked for deletion, while handlers can still use them.
  void endMarked(World& world);
  bool isTouching(ObjectKey key) const { return m_contacts.isTouching(key); }
  const ImpactCounters& impactCounters() const { return m_impacts.counters(); }
  std::int64_t sensorPairs() const { return m_sensors.pairs(); }
  const RigidCounters& rigidCounters() const { return m_rigid_world.counters(); }
  const LinkageCounters& linkageCounters() const { return m_rigid_world.linkageCounters(); }
  const SubstepCounters& substepCounters() const { return m_substep_world.counters(); }
  const SubstepCounters& heapCounters() const { return m_heap_world.counters(); }

 private:
  using State = BodyState;

  void beginBody(World& world, BodyTable::Index index);
  void send(World& world, std::vector<BodyContact>& contacts);
  Vec2 pushBesideMagnet(State& state);
  IntegratorStatus flyFreely(const State& state, Flown& flown);
  void fly(State& state);
  Vec2 swingOf(const State& state) const;
  void measure(const WorldStore& store, State& state);
  void chooseSolvers(const WorldStore& store);
  void chooseFast();
  void passOnGivenUp();
  void assignSolver(const WorldStore& store, State& state);
  void turnByTorque(State& state);
  void settle(World& world, State& state);
  void publish(World& world, const State& state, BodyRow& row, FixedVector velocity);
  void limit(World& world, State& state);
  void countLimited(World& world, const State& state);
  void quarantine(World& world, State& state, const char* p_why);
  void logCrowd(World& world);
  void logScaling(World& world);
  void logSunk(World& world);

  /// Speed below which bodies may sleep, in cells per tick. It is small, so that bodies that begin to slide
  /// down a slope do not sleep.
  static constexpr double kSleepSpeed = 1e-5;

  std::shared_ptr<BodyTable> m_table;
  BodyLinks m_links;
  BodyImpacts m_impacts;
  BodyIslands m_islands;
  RigidWorld m_rigid_world{RigidOptions{.sleep_speed = kSleepSpeed}};
  SubstepWorld m_substep_world;
  // With this, 500 boxes in a drum need less time and overlap less than in Box2D with 4 sub-steps, each of 8
  // velocity and 3 position iterations.
  SubstepWorld m_heap_world{SubstepOptions{.searches = 2, .substeps = 5}};
  BodyRigids m_rigids{BodySolver::kRigid, m_rigid_world};
  BodyRigids m_substeps{BodySolver::kSubstep, m_substep_world};
  BodyRigids m_heaps{BodySolver::kHeap, m_heap_world};
  BodyPlatforms m_platforms;
  BodyContacts m_contacts;
  BodySensors m_sensors;
  int m_kinematic = 0;  // number of HARD kinematic bodies in this tick
  // Scratch memory of a step.
  std::vector<State> m_states;
  std::vector<double> m_unit_inertias;  // by state; 0: the body does not turn
  // True if m_islands must choose the solvers: a HARD body is joined, cannot be moved by an ImpactWorld or
  // was moved by a SubstepWorld, or any body must be held, is costly or is in a heap.
  bool m_is_mixed = false;
  bool m_has_joined = false;              // true if any body is joined
  std::int64_t m_evaluations_before = 0;  // evaluations of fields before this tick
  bool m_was_fast = false;
  bool m_has_substeps = false;  // true if the SubstepWorld moves any body
  std::vector<MovedObject> m_moved;
  bool m_has_logged_crowd = false, m_has_logged_scaling = false, m_has_logged_sunk = false;
};

}  // namespace naiad::physics
