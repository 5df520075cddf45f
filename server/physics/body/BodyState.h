// A body's state within a tick, from the table's row until it is published.
#pragma once

#include "engine/world/WorldView.h"
#include "physics/body/BodyFlight.h"
#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"

namespace naiad::physics {

/// What moves it.
enum class BodySolver : std::uint8_t {
  kFlight,        ///< nothing can touch it: its own flight
  kImpact,        ///< ImpactWorld: it does not turn, and is a box along the axes or a circle
  kJoints,        ///< JointSolver
  kRigid,         ///< RigidWorld
  kJointImpacts,  ///< JointSolver, from impact to impact (JointImpacts): circles may hit it
  kSubstep,       ///< SubstepWorld: at ACCURACY_FAST, or what would cost the others too much
  kHeap,          ///< another one, in finer steps: large groups that a RigidWorld has given up
};

/// Is that a SubstepWorld?
constexpr bool isSoft(BodySolver solver) {
  return solver == BodySolver::kSubstep || solver == BodySolver::kHeap;
}

struct BodyState {
  BodyTable::Index index;
  ObjectKey key;
  std::uint64_t order = 0;  ///< the Object's, in the world
  BodySolver solver = BodySolver::kFlight;
  bool is_hard = false;
  bool is_soft = false;
  bool is_costly = false;   ///< on joints, or after impacts, that cost more than their number allows
  bool is_in_heap = false;  ///< the RigidWorld has given it up in the last tick
  bool is_kinematic = false;
  bool is_joined = false;
  bool is_simple = false;         ///< an ImpactWorld can have it
  bool is_sprung = false;         ///< a spring or a stiff field pulls it: what holds it must know `pull`
  bool must_be_held = false;      ///< its flight is not known, or no JointSolver follows its `pull` or magnet
  double turn_rate = 0;           ///< of the magnet that turns it where something holds it: rad per tick
  bool is_bent = false;           ///< its own path is not that of a constant acceleration
  bool is_near_rigid = false;     ///< kinematic, and on the path of one in the RigidWorld
  bool is_near_substep = false;   ///< the same of the SubstepWorld
  bool is_touched = false;        ///< by anything, in this tick or the last one
  bool contacts_changed = false;  ///< a contact began or ended in this tick
  bool turns_alone = true;        ///< nothing turns it but its own torque
  int group = -1;                 ///< with solver kJointImpacts: bodies that may hit one another
  const char* p_failure = nullptr;  ///< why it has to be frozen; null: it has not
  double radius = 0;                ///< of a circle about its place that does not turn; 0: it is none
  Place start;                      ///< at the beginning of the tick
  Vec2 start_velocity;
  Vec2 push;    ///< gravity and force over mass
  Pull pull;    ///< if it is sprung
  Vec2 size;    ///< of its shape, with some room
  Vec2 reach;   ///< how far around `start` it gets on its own, its shape included
  Flown flown;  ///< where it would go on its own
  Place place;  ///< at the end
  Vec2 velocity;
  Rotation rotation;
  double spin = 0;
  Vec2 acceleration;  ///< what clients extrapolate with

  /// Does `pull` act on it, where it does not fly on its own?
  bool isPulled() const { return is_sprung && (pull.spring.stiffness > 0 || pull.spring.damping > 0); }
};

/// Two bodies of a group with solver kJointImpacts whose paths may cross in this tick: indices of states.
struct BodyCandidatePair {
  int group = -1;
  int a = -1, b = -1;  ///< a < b
  friend constexpr bool operator<(const BodyCandidatePair& x, const BodyCandidatePair& y) {
    if (x.group != y.group) return x.group < y.group;
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  }
};

/// An Object that gets another position once all have moved.
struct MovedObject {
  ObjectKey key;
  FixedVector where;
};

/// What becomes of contacts.
struct BodyContact {
  double time = 0;  ///< 0 … 1, within the tick
  ObjectKey first, second;
  std::uint64_t first_order = 0, second_order = 0;
  double impulse = 0;
  bool is_begin = true;
  BodySolver by = BodySolver::kFlight;  ///< which solver found it
};

}  // namespace naiad::physics
