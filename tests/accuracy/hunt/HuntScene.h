// A scene of the hunt as plain data, from which LiveScene.h builds a world.
//
// Lengths are in metric cells (cell widths along both axes), times in ticks, y points down. Nothing is erased
// from the lists, so that indices stay valid: elements that were removed are marked as absent.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "physics/body/PhysicsManager.h"
#include "physics/geometry/Vec2.h"
#include "shared/values/Solidness.h"

namespace hunt {

using naiad::physics::cross;
using naiad::physics::dot;
using naiad::physics::length;
using naiad::physics::Vec2;

inline constexpr int kNothing = -1;  ///< index of no body; in joints the world itself

/// One shape of a body.
struct Part {
  enum class Kind { CIRCLE, BOX, POLYGON };
  Kind kind = Kind::BOX;
  Vec2 size = {1, 1};  ///< full sides of a box; x is the radius of a circle
  Vec2 centre = {};    ///< relative to the body's position; only of the second part on
  double angle = 0;    ///< box's angle; only of the second part on
  std::vector<Vec2> corners = {};
};

/// A force towards the origin of a field, or across the velocity.
struct FieldData {
  enum class Kind { LINEAR, TANH, MAGNET };
  Kind kind = Kind::LINEAR;
  double strength = 0;   ///< acceleration per cell; most acceleration on each axis; radians per tick
  double steepness = 1;  ///< TANH only, per cell
};

struct BodyData {
  bool present = true;
  int group = 0;
  int row = kNothing;       ///< tiles with equal numbers are one surface
  std::vector<Part> parts;  ///< empty: the Object's box of one cell
  double mass = 1;
  double restitution = 0;
  double friction = 0.5;
  bool turning = false;
  bool kinematic = false;
  df::Solidness solidness = df::HARD;
  bool contact_ends = false;
  Vec2 place, velocity;
  double angle = 0;
  double spin = 0;
  double gravity_scale = 1;
  double linear_drag = 0, quadratic_drag = 0;
  Vec2 anchor;  ///< end of its spring
  double stiffness = 0, damping = 0;
  int field = kNothing;
  Vec2 field_origin;

  bool isDynamic() const { return present && !kinematic; }
};

/// An Object that is not a body.
struct ObstacleData {
  bool present = true;
  int group = 0;
  int row = kNothing;
  Vec2 centre, half;
  df::Solidness solidness = df::HARD;
};

struct JointData {
  enum class Kind { DISTANCE, ROPE, HINGE, WELD, SLIDER, SPRING, MOTOR, LIMIT, MOUSE };
  bool present = true;
  Kind kind = Kind::DISTANCE;
  int a = kNothing, b = kNothing;
  Vec2 point_a, point_b;   ///< places at the start. Joints with one point have it twice
  Vec2 axis = {1, 0};      ///< slider's direction
  double first = 0;        ///< stiffness, speed, lower limit; strength of a mouse joint
  double second = 0;       ///< damping, strength, upper limit; stiffness of a mouse joint, 0: the mass
  double length = 0;       ///< 0: the distance of the points at the start
  double break_force = 0;  ///< 0: never
  bool has_target = false;
  Vec2 target;  ///< mouse joint's target
};

/// One call of a setter, or a deletion, during the scene.
struct Action {
  enum class Kind {
    MASS,
    RESTITUTION,
    FRICTION,
    TURNING,
    KINEMATIC,
    SOLIDNESS,
    VELOCITY,
    SPIN,
    POSITION,
    ANGLE,
    GRAVITY_SCALE,
    DRAG,
    SPRING,
    CIRCLE,
    BOX,
    IMPULSE,
    FORCE,
    MARK_BODY,
    DELETE_BODY,
    DELETE_OBSTACLE,
    MOVE_OBSTACLE,
    OBSTACLE_SOLIDNESS,
    REMOVE_JOINT,
    JOINT_LENGTH,
    JOINT_STIFFNESS,
    JOINT_SPEED,
    JOINT_STRENGTH,
    JOINT_LIMITS,
    JOINT_TARGET,
    GRAVITY,
    OBSTACLE_FRICTION,
    OBSTACLE_RESTITUTION,
    LEVEL,
    SLEEPING,
  };
  static constexpr int kKinds = static_cast<int>(Kind::SLEEPING) + 1;
  enum class When { TICK, BEGIN, END };

  bool present = true;
  When when =
      When::TICK;  ///< TICK: before the tick. Others: in the first such event of the receiver from then on
  int tick = 0;
  int receiver = kNothing;
  Kind kind = Kind::FRICTION;
  int target = kNothing;  ///< index of a body, obstacle or joint
  double x = 0, y = 0;
};

/// A rectangle that the centres of dynamic bodies must not leave, or a wall that they must not cross.
struct Boundary {
  enum class Kind { ROOM, WALL_X, WALL_Y };  ///< WALL_X stops motion along x
  Kind kind = Kind::ROOM;
  Vec2 lower, upper;  ///< corners at the start: of the room's outside, or of the wall
  Vec2 velocity;
};

struct SceneData {
  std::uint64_t seed = 0;
  std::string family;
  double aspect = 1;
  df::Accuracy level = df::ACCURACY_DEFAULT;
  bool sleeping = true;
  Vec2 gravity = {0, 0.01};
  double obstacle_friction = 0.5;
  double obstacle_restitution = 0;
  int ticks = 60;
  bool later_groups_first = false;  ///< groups are made in descending order
  std::vector<FieldData> fields;
  std::vector<BodyData> bodies;
  std::vector<ObstacleData> obstacles;
  std::vector<JointData> joints;
  std::vector<Action> actions;
  std::vector<Boundary> boundaries;

  /// Returns the group of an action: that of its target, or kNothing if it acts on the whole world.
  int groupOf(const Action& action) const;
  int groupOf(const JointData& joint) const {
    return bodies[static_cast<std::size_t>(joint.a != kNothing ? joint.a : joint.b)].group;
  }
};

/// List that an action's `target` is an index of.
enum class TargetKind { BODY, OBSTACLE, JOINT, WORLD };
TargetKind targetOf(Action::Kind kind);
/// True if the action changes places or shapes, so that bodies may overlap and joints may be open after it.
bool displaces(Action::Kind kind);

/// Draws the scene of this seed. A seed gives equal scenes on every machine.
SceneData drawScene(std::uint64_t seed);
/// Adds a group 4,000 cells away, with the number 1, from the scene's seed.
void addDistantGroup(SceneData& scene);
/// Returns the scene with one wide element in place of the tiles of each row.
SceneData withoutSeams(const SceneData& scene);

}  // namespace hunt
