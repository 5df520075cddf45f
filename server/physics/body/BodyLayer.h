// The physics' part of a world's update(): all bodies go on for one tick, at once.
//
// A world gets this layer with its first Body or its first PM.set…, and pays nothing before. Each body is
// moved by one of several: its own flight if nothing can touch it, an ImpactWorld, a JointSolver, a
// RigidWorld; which one, is chosen anew in each tick (BodyIslands.h).
#pragma once

#include <memory>
#include <vector>

#include "engine/world/Layer.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyImpacts.h"
#include "physics/body/BodyIslands.h"
#include "physics/body/BodyLinks.h"
#include "physics/body/BodyPlan.h"
#include "physics/body/BodyRigids.h"
#include "physics/body/BodyTable.h"
#include "physics/body/BodyTouches.h"

namespace df {

class BodyLayer : public Layer {
 public:
  BodyLayer() : m_table(std::make_shared<naiad::physics::BodyTable>()) {}
  /// The layer of this world; made if there is none.
  static BodyLayer& of(World& world);

  void step(World& world) override;
  const std::shared_ptr<naiad::physics::BodyTable>& table() { return m_table; }
  /// Of this tick, for layers that come after.
  const std::vector<naiad::physics::BodyPlan>& plans() const { return m_plans; }
  bool isTouching(ObjectKey key) const { return m_touching.isTouching(key); }
  const naiad::physics::ImpactCounters& impactCounters() const { return m_impacts.counters(); }
  const naiad::physics::RigidCounters& rigidCounters() const { return m_rigids.counters(); }
  const naiad::physics::JointCounters& jointCounters() const { return m_links.counters(); }

 private:
  using Plan = naiad::physics::BodyPlan;

  void plan(World& world, naiad::physics::BodyTable::Index index);
  void fly(Plan& plan);
  void size(const WorldStore& store, Plan& plan);
  void choose(const WorldStore& store);
  void hand(const WorldStore& store, Plan& plan);
  void turnAlone(Plan& plan);
  void settle(World& world, Plan& plan);
  void tell(World& world, const Plan& plan, naiad::physics::BodyRow& row, FixedVector velocity);
  void quarantine(World& world, Plan& plan, const char* p_why);
  void tellOfCrowd(World& world);

  struct Moved {
    ObjectKey key;
    FixedVector where;
  };
  std::shared_ptr<naiad::physics::BodyTable> m_table;
  naiad::physics::BodyLinks m_links;
  BodyImpacts m_impacts;
  BodyIslands m_islands;
  BodyRigids m_rigids;
  naiad::physics::BodyContacts m_touching;
  BodyTouches m_touches;
  // Of this step; kept for their memory.
  std::vector<Plan> m_plans;
  std::vector<double> m_unit_inertias;  // by plan; 0: it does not turn
  bool m_is_mixed = false;              // is any HARD body joined, or more than a box or a circle?
  std::vector<Moved> m_moved;
  bool m_has_told_of_crowd = false;
};

}  // namespace df
