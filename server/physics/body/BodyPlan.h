// What a body is about to do in a tick, from the moment it is looked at until the world is told.
#pragma once

#include "engine/world/WorldView.h"
#include "physics/body/BodyTable.h"
#include "physics/flight/FlightFree.h"

namespace naiad::physics {

/// Who moves it.
enum class BodyWay : std::uint8_t {
  kAlone,   ///< nothing can touch it: its own flight
  kImpact,  ///< ImpactWorld: it does not turn, and is a box along the axes or a circle
  kJoined,  ///< JointSolver
  kRigid,   ///< RigidWorld
  kStruck,  ///< JointSolver, from impact to impact (JointImpacts): it may be struck by circles
};

struct BodyPlan {
  BodyTable::Index index;
  df::ObjectKey key;
  std::uint64_t order = 0;  ///< the Object's, in the world
  BodyWay way = BodyWay::kAlone;
  bool is_hard = false;
  bool is_soft = false;
  bool is_kinematic = false;
  bool is_joined = false;
  bool is_simple = false;           ///< an ImpactWorld can have it
  bool is_bent = false;             ///< its own path is not that of a constant acceleration
  bool is_near_rigid = false;       ///< kinematic, and in the way of those in the RigidWorld
  bool is_touched = false;          ///< by anything, in this tick or the last one
  bool is_struck = false;           ///< a contact began or ended in this tick
  bool turns_alone = true;          ///< nothing turns it but its own torque
  int group = -1;                   ///< on the way kStruck: who may be struck by the same ones
  const char* p_failure = nullptr;  ///< why it has to be frozen; null: it has not
  double radius = 0;                ///< of a circle about its place that does not turn; 0: it is none
  Place start;                      ///< at the beginning of the tick
  Vec2 start_velocity;
  Vec2 push;    ///< gravity and force over mass
  Vec2 reach;   ///< how far around `start` it gets on its own, its shape included
  Flown flown;  ///< where it would go on its own
  Place place;  ///< at the end
  Vec2 velocity;
  Rotation rotation;
  double spin = 0;
  Vec2 acceleration;  ///< what a watcher extrapolates with
};

/// Two plans of a group on the way kStruck that may meet in this tick.
struct BodyMeeting {
  int group = -1;
  int a = -1, b = -1;  ///< a < b
  friend constexpr bool operator<(const BodyMeeting& x, const BodyMeeting& y) {
    if (x.group != y.group) return x.group < y.group;
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  }
};

/// What becomes of contacts.
struct BodyContact {
  double time = 0;  ///< 0 … 1, within the tick
  df::ObjectKey first, second;
  std::uint64_t first_order = 0, second_order = 0;
  double impulse = 0;
  bool is_begin = true;
  BodyWay by = BodyWay::kAlone;  ///< which solver found it
};

}  // namespace naiad::physics
