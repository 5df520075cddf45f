// A body's state during a tick, from the reading of its row in the table until its new position is published.
#pragma once

#include "engine/world/WorldView.h"
#include "physics/body/BodyFlight.h"
#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"

namespace naiad::physics {

/// The solver that moves a body.
enum class BodySolver : std::uint8_t {
  kFlight,   ///< the body's own flight, because nothing can touch it
  kImpact,   ///< ImpactWorld, only for boxes along the axes and circles that do not turn
  kRigid,    ///< RigidWorld
  kSubstep,  ///< SubstepWorld, at ACCURACY_FAST or if the other solvers would be too expensive
  kHeap,     ///< a SubstepWorld with finer steps, for groups that a RigidWorld abandoned
  kSensor,   ///< none: one of the contact's Objects is SOFT (BodySensors)
};

/// True for the solvers that use a SubstepWorld.
constexpr bool isSoft(BodySolver solver) {
  return solver == BodySolver::kSubstep || solver == BodySolver::kHeap;
}

struct BodyState {
  BodyTable::Index index;
  ObjectKey key;
  std::uint64_t order = 0;  ///< creation order of the Object in the world
  BodySolver solver = BodySolver::kFlight;
  bool is_hard = false;
  bool is_soft = false;
  bool is_costly = false;   ///< too expensive for its solver, because of joints or impacts
  bool is_in_heap = false;  ///< a RigidWorld abandoned its group in the last tick
  bool is_kinematic = false;
  bool is_joined = false;
  bool has_joints = false;       ///< like is_joined, but also true for a kinematic body
  bool is_merged = false;        ///< kinematic and a part of a platform, which has its shape in solvers
  bool is_simple = false;        ///< an ImpactWorld can move it
  bool is_sprung = false;        ///< a spring or stiff field pulls it: solvers must use `pull`
  bool is_alone = false;         ///< joined, and nothing may touch its group in this tick
  bool must_be_held = false;     ///< a solver must apply its pull or magnet, because it touches something, is
                                 ///< joined, or its flight is unknown
  double turn_rate = 0;          ///< rad per tick by which a magnet turns its path; 0: nothing can hold it
  bool is_bent = false;          ///< its free path is not that of a constant acceleration
  bool is_near_rigid = false;    ///< kinematic and on the path of a body in the RigidWorld
  bool is_near_substep = false;  ///< kinematic and on the path of a body in a SubstepWorld
  bool is_touched = false;       ///< kImpact only: touched by anything in this or the last tick
  bool contacts_changed = false;    ///< a contact began or ended in this tick
  bool turns_alone = true;          ///< true if only the torque applied by the game turns it
  const char* p_failure = nullptr;  ///< reason to freeze the body, or null
  double radius = 0;  ///< radius if it is a circle that an ImpactWorld can move (is_simple); else 0
  Place start;        ///< place at the beginning of the tick
  Vec2 start_velocity;
  Vec2 push;    ///< gravity plus applied force over mass
  Pull pull;    ///< valid if is_sprung
  Vec2 size;    ///< half size of the shape, with some margin
  Vec2 reach;   ///< half size of the area around `start` that it can reach by itself, including its shape
  Flown flown;  ///< flight if nothing touches it
  Place place;  ///< place at the end of the tick
  Vec2 velocity;
  Rotation rotation;
  double spin = 0;
  Vec2 acceleration;  ///< published for the clients' extrapolation

  /// True if `pull` acts on the body while a solver other than its own flight moves it.
  bool isPulled() const { return is_sprung && (pull.spring.stiffness > 0 || pull.spring.damping > 0); }
};

/// An Object that gets a new position after all bodies have moved.
struct MovedObject {
  ObjectKey key;
  FixedVector where;
};

/// The start or end of a contact.
struct BodyContact {
  double time = 0;  ///< 0 … 1, within the tick
  ObjectKey first, second;
  std::uint64_t first_order = 0, second_order = 0;
  double impulse = 0;
  bool is_begin = true;
  BodySolver by = BodySolver::kFlight;  ///< solver that found it
  std::uint8_t missed = 0;  ///< bit 0: `first` did not get the event of its begin; bit 1: nor did `second`
};

}  // namespace naiad::physics
