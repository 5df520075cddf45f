// The bodies that a RigidWorld or a SubstepWorld moves, their joints and obstacles: keeps that world in step
// with the table.
#pragma once

#include <vector>

#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodySurroundings.h"
#include "physics/rigid/RigidWorld.h"
#include "physics/substep/SubstepWorld.h"

namespace df {

class BodyRigids {
 public:
  BodyRigids() = default;
  BodyRigids(const BodyRigids&) = delete;
  BodyRigids& operator=(const BodyRigids&) = delete;

  /// Does no body take part, and did none in the last tick?
  bool isEmpty() const { return m_count == 0; }
  /// Steps the bodies with solver kRigid by a tick, with the kinematic ones near them. `unit_inertias` by
  /// state; 0: it does not turn.
  void step(const WorldStore& store, naiad::physics::BodyTable& table,
            std::vector<naiad::physics::BodyState>& states, const std::vector<double>& unit_inertias,
            naiad::physics::BodyContacts& contacts);

  const naiad::physics::RigidCounters& counters() const { return m_exact.counters(); }
  const naiad::physics::SubstepCounters& substepCounters() const { return m_fast.counters(); }

 private:
  struct Proxy {  // by row of the table
    std::uint64_t order = 0;
    int id = -1;
    bool is_used = false;
    std::uint32_t version = 0;  // of the form
    FixedBox box;               // of the Object, if that is its shape
  };
  struct JointProxy {  // by entry of the table's joints
    std::uint32_t generation = 0;
    std::uint32_t tunings = 0;
    int id = -1;
    int anchor = -1;  // the body that stands for the world
  };
  struct Identity {  // by id
    ObjectKey key;
    std::uint64_t order = 0;
    int state = -1;  // −1: an obstacle
  };

  void chooseWorld(const naiad::physics::BodySettings& settings, naiad::physics::BodyContacts& contacts);
  void updateBodies(const WorldStore& store, const naiad::physics::BodyTable& table,
                    const std::vector<naiad::physics::BodyState>& states,
                    const std::vector<double>& unit_inertias);
  void shape(Proxy& proxy, const naiad::physics::BodyTable& table, const naiad::physics::BodyState& state,
             const FixedBox& box, const naiad::physics::RigidBody& body);
  void updateObstacles(const WorldStore& store, const naiad::physics::BodyTable& table,
                       const std::vector<naiad::physics::BodyState>& states,
                       naiad::physics::BodyContacts& contacts);
  void updateJoints(const naiad::physics::BodyTable& table);
  void identify(int id, ObjectKey key, std::uint64_t order, int state);
  void collect(std::vector<naiad::physics::BodyState>& states, naiad::physics::BodyContacts& contacts) const;
  void finish(naiad::physics::BodyTable& table, std::vector<naiad::physics::BodyState>& states,
              const naiad::physics::BodyContacts& contacts);
  int rigidOf(int row) const;

  /// Cells per tick. What has just begun to slide down a slope is slow for long, and must not fall asleep.
  static constexpr double kSleepSpeed = 1e-5;

  naiad::physics::RigidWorld m_exact{naiad::physics::RigidOptions{.sleep_speed = kSleepSpeed}};
  naiad::physics::SubstepWorld m_fast;
  naiad::physics::RigidStepper* m_p_world = &m_exact;  // one of both
  std::vector<Proxy> m_proxies;
  std::vector<JointProxy> m_joint_proxies;
  std::vector<Identity> m_identities;
  BodyObstacles m_obstacles;
  std::vector<FixedBox> m_obstacle_boxes;  // by id
  BodySurroundings m_surroundings;
  std::vector<naiad::physics::ConvexShape> m_shapes;
  int m_count = 0;
  bool m_may_sleep = true;
};

}  // namespace df
