// The bodies of a RigidWorld, their joints, and what stands in their way.
#pragma once

#include <vector>

#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/body/BodyPlan.h"
#include "physics/body/BodySurroundings.h"
#include "physics/rigid/RigidWorld.h"

namespace df {

class BodyRigids {
 public:
  /// Does anybody take part, or has anybody until now?
  bool isEmpty() const { return m_count == 0; }
  /// Lets a tick pass for the plans that go this way, with the kinematic ones near them. `unit_inertias` by
  /// plan; 0: it does not turn.
  void step(const WorldStore& store, naiad::physics::BodyTable& table,
            std::vector<naiad::physics::BodyPlan>& plans, const std::vector<double>& unit_inertias,
            naiad::physics::BodyContacts& contacts);

  const naiad::physics::RigidCounters& counters() const { return m_world.counters(); }

 private:
  struct Seat {  // by row of the table
    std::uint64_t order = 0;
    int id = -1;
    bool is_taken = false;
    std::uint32_t version = 0;  // of the form
    FixedBox box;               // of the Object, if that is its shape
  };
  struct JointSeat {  // by entry of the table's joints
    std::uint32_t generation = 0;
    std::uint32_t tunings = 0;
    int id = -1;
    int anchor = -1;  // the body that stands for the world
  };
  struct Who {  // by id
    ObjectKey key;
    std::uint64_t order = 0;
    int plan = -1;  // −1: an obstacle
  };

  void sitDown(const WorldStore& store, const naiad::physics::BodyTable& table,
               const std::vector<naiad::physics::BodyPlan>& plans, const std::vector<double>& unit_inertias);
  void shape(Seat& seat, const naiad::physics::BodyTable& table, const naiad::physics::BodyPlan& plan,
             const FixedBox& box, const naiad::physics::RigidBody& body);
  void takeObstacles(const WorldStore& store, const naiad::physics::BodyTable& table,
                     const std::vector<naiad::physics::BodyPlan>& plans,
                     naiad::physics::BodyContacts& contacts);
  void takeJoints(const naiad::physics::BodyTable& table);
  void know(int id, ObjectKey key, std::uint64_t order, int plan);
  void collect(std::vector<naiad::physics::BodyPlan>& plans, naiad::physics::BodyContacts& contacts) const;
  void finish(naiad::physics::BodyTable& table, std::vector<naiad::physics::BodyPlan>& plans,
              const naiad::physics::BodyContacts& contacts);
  int rigidOf(int row) const;

  /// Cells per tick. What has just begun to slide down a slope is slow for long, and must not fall asleep.
  static constexpr double kSleepSpeed = 1e-5;

  naiad::physics::RigidWorld m_world{naiad::physics::RigidOptions{.sleep_speed = kSleepSpeed}};
  std::vector<Seat> m_seats;
  std::vector<JointSeat> m_joint_seats;
  std::vector<Who> m_who;
  BodyObstacles m_obstacles;
  std::vector<FixedBox> m_obstacle_boxes;  // by id
  BodySurroundings m_surroundings;
  std::vector<naiad::physics::ConvexShape> m_shapes;
  int m_count = 0;
};

}  // namespace df
