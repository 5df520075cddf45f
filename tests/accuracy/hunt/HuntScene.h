// A scene of the hunt as plain data, from which LiveScene.h builds a world.
//
// Lengths are in metric cells (cell widths along both axes), times in ticks, y points down. Nothing is erased
// from the lists, so that indices stay valid: elements that were removed are marked as absent.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
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

/// Returns the number of an obstacle among bodies, which have their index; and from a number the index.
constexpr int obstacleNumber(int index) {
  return -2 - index;
}

template <class List>
auto& at(List& list, int index) {
  return list[static_cast<std::size_t>(index)];
}
/// True if an element of the list that is present has a property.
template <class List, class Is>
bool any(const List& list, Is is) {
  return std::any_of(list.begin(), list.end(), [&](const auto& its) { return its.present && is(its); });
}

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

/// A body. As an obstacle, a plain Object: it has one box, place, solidness, group and row, and is kinematic.
struct BodyData {
  bool present = true;
  int group = 0;
  int row = kNothing;       ///< tiles with equal numbers are one surface
  std::vector<Part> parts;  ///< empty: the Object's box of one cell
  double mass = 1, restitution = 0, friction = .5;
  bool turning = false, kinematic = false, contact_ends = false;
  df::Solidness solidness = df::HARD;
  Vec2 place{}, velocity{};
  double angle = 0, spin = 0;
  double gravity_scale = 1, linear_drag = 0, quadratic_drag = 0;
  Vec2 anchor{};  ///< end of its spring
  double stiffness = 0, damping = 0;
  int field = kNothing;
  Vec2 field_origin{};

  bool isDynamic() const { return present && !kinematic; }
  Vec2 half() const { return .5 * parts[0].size; }
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
  Vec2 target;             ///< mouse joint's

  double restLength() const { return length > 0 ? length : naiad::physics::length(point_b - point_a); }
};

enum class TargetKind { BODY, OBSTACLE, JOINT, WORLD };

/// A setter that can be called during a scene, or a deletion.
struct Setter {
  std::string_view name;
  TargetKind target;
  bool displaces;                ///< bodies may overlap and joints may be open after it
  std::vector<double> x{}, y{};  ///< values to draw from, or with is_range between; empty: a vector's
  bool is_range = false;
};
/// Returns all setters. LiveScene.cpp has their calls.
const std::vector<Setter>& setters();
/// Returns the setter of this name, which must exist.
const Setter& setterNamed(std::string_view name);

/// One call of a setter, or a deletion, during the scene.
struct Action {
  enum class When { TICK, BEGIN, END };
  bool present = true;
  /// TICK: before the tick. Others: in the first such event of the receiver from then on.
  When when = When::TICK;
  int tick = 0, receiver = kNothing;
  const Setter* p_setter = nullptr;
  int target = kNothing;  ///< index of a body, obstacle or joint
  double x = 0, y = 0;

  bool is(std::string_view name) const { return p_setter == &setterNamed(name); }
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
  double obstacle_friction = 0.5, obstacle_restitution = 0;
  int ticks = 60;
  bool later_groups_first = false;  ///< groups are made in descending order
  std::vector<FieldData> fields;
  std::vector<BodyData> bodies, obstacles;
  std::vector<JointData> joints;
  std::vector<Action> actions;
  std::vector<Boundary> boundaries;

  bool isFast() const { return level == df::ACCURACY_FAST; }
  int groupOf(const JointData& joint) const { return at(bodies, std::max(joint.a, joint.b)).group; }
};

/// Draws the scene of this seed. A seed gives equal scenes on every machine.
SceneData drawScene(std::uint64_t seed);
/// Adds a group 4,000 cells away, with the number 1, from the scene's seed.
void addDistantGroup(SceneData& scene);
/// Returns the scene with one wide element in place of the tiles of each row.
SceneData withoutSeams(const SceneData& scene);

}  // namespace hunt
