// Keeps a RigidWorld or SubstepWorld up to date with the BodyTable: its bodies, their joints and obstacles.
#pragma once

#include <vector>

#include "physics/body/BlockContacts.h"
#include "physics/body/BodyContacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/body/BodyPlatforms.h"
#include "physics/body/BodyState.h"
#include "physics/body/BodySurroundings.h"
#include "physics/rigid/RigidStepper.h"

namespace naiad::physics {

class BodyRigids {
 public:
  /// `solver` is the kind of `stepper`: kRigid, kSubstep or kHeap.
  BodyRigids(BodySolver solver, RigidStepper& stepper) : m_solver(solver), m_world(stepper) {}
  BodyRigids(const BodyRigids&) = delete;
  BodyRigids& operator=(const BodyRigids&) = delete;

  /// True if no body is moved in this tick, and none was in the last one.
  bool isEmpty() const { return m_count == 0; }
  /// True if the last step abandoned the body's group, so that it goes to the solver for heaps.
  bool isGivenUp(const BodyTable& table, BodyTable::Index row) const;
  /// Steps the bodies with this solver, and kinematic ones near them. `unit_inertias` has one number for each
  /// state; 0: the body does not turn.
  void step(const WorldStore& store, BodyTable& table, const BodyPlatforms& platforms,
            std::vector<BodyState>& states, const std::vector<double>& unit_inertias, BodyContacts& contacts);

 private:
  struct Proxy {  // by row of the table
    std::uint64_t order = 0;
    int id = -1;
    bool is_used = false;
    std::uint32_t version = 0;  // version of the BodyGeometry
    FixedBox box;               // the Object's box, if that is the shape
  };
  struct JointProxy {  // by index of the entry in the table's joints
    std::uint32_t generation = 0;
    std::uint32_t tunings = 0;
    int id = -1;
    int anchor = -1;  // the body that represents the world
  };
  struct PullProxy {  // by row of the table: the joint for the pull on the row's body
    std::uint64_t order = 0;
    int id = -1;
    Pull pull;
    double mass = 0;
    bool is_used = false;
  };
  /// Part of the x axis with bodies that may reach each other in this tick, directly or through others.
  struct Stretch {
    double low, high;
    Vec2 fastest;  ///< maximum speeds of their points along each axis at the start of the tick
  };
  struct PlatformProxy {
    int serial = 0;  // of the platform
    int id = -1;
    bool is_used = false;
  };
  struct Identity {  // entry of m_identities, which is indexed by id in the solver
    ObjectKey key;
    std::uint64_t order = 0;
    int state = -1;  // index of the state; −1: an obstacle
    int block = -1;  // index of the block or platform; −1: a body
    bool is_platform = false;
  };

  bool isStepped(const BodyState& state) const;
  void remove(Proxy& proxy, BodyContacts& contacts);
  void updateBodies(const WorldStore& store, const BodyTable& table, std::vector<BodyState>& states,
                    const std::vector<double>& unit_inertias, BodyContacts& contacts);
  void shape(Proxy& proxy, const BodyTable& table, const BodyState& state, const FixedBox& box,
             const RigidBody& body);
  void findStretches(const std::vector<BodyState>& states);
  Vec2 fastestNear(const Place& place) const;
  void updateObstacles(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states,
                       BodyContacts& contacts);
  void setFrictions(const Metric& metric, const BodyPlatforms::Platform& platform,
                    std::span<const BlockContacts::Member> members, int id);
  void updatePlatforms(const BodyTable& table, const BodyPlatforms& platforms,
                       const std::vector<BodyState>& states);
  bool isHere(const JointEntry& entry) const;
  bool isPulledHere(const BodyState& state) const;
  void removeJoints(const BodyTable& table, const std::vector<BodyState>& states);
  void updateJoints(const BodyTable& table);
  void updatePulls(const BodyTable& table, const std::vector<BodyState>& states);
  void identify(int id, const Identity& identity);
  void collect(const WorldStore& store, const BodyTable& table, const BodyPlatforms& platforms,
               std::vector<BodyState>& states, BodyContacts& contacts);
  void settleBlocks(const WorldStore& store, const BodyTable& table, const BodyPlatforms& platforms,
                    const std::vector<BodyState>& states, BodyContacts& contacts);
  void finish(BodyTable& table, std::vector<BodyState>& states);
  int rigidOf(int row) const;

  BodySolver m_solver;
  RigidStepper& m_world;
  std::vector<Proxy> m_proxies;
  std::vector<JointProxy> m_joint_proxies;
  std::vector<PullProxy> m_pull_proxies;
  std::vector<PlatformProxy> m_platform_proxies;
  std::vector<FrictionPart> m_friction_parts;
  std::vector<Identity> m_identities;
  BodyObstacles m_obstacles;
  BlockContacts m_block_contacts;
  BodySurroundings m_surroundings;
  int m_count = 0;
  bool m_has_pulls = false;          // true if a pull acts on one of its bodies in this tick
  std::vector<Stretch> m_stretches;  // sorted; empty if all bodies are slow
  bool m_may_sleep = true;
};

}  // namespace naiad::physics
