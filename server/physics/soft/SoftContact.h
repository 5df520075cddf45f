// Finds contacts of soft bodies with rigid ones and with each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Place.h"
#include "physics/geometry/Rotation.h"
#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// A rigid body as soft bodies see it during one step. Within the step it moves by its velocity, its
/// acceleration and the soft bodies' forces. The fields marked "out" add up the effects of these forces,
/// which the SoftLayer applies.
struct SoftObstacle {
  int id = 0;  ///< chosen by the caller and unique in a step; attachments and events use it
  std::span<const ConvexShape> shapes;
  Place place;  ///< place of the centre of mass, the shapes' origin
  Rotation rotation;
  Vec2 velocity;      ///< metric cells per tick
  double spin = 0;    ///< rad per tick
  Vec2 acceleration;  ///< from all forces except those of soft bodies, so that a body at rest stays at rest
  double inverse_mass = 0;
  double inverse_inertia = 0;
  double friction = 0;

  Vec2 impulse;                ///< out: mass · cells per tick
  double angular_impulse = 0;  ///< out: about the centre of mass
  Vec2 displacement;           ///< out: movement within the step
  double turn = 0;             ///< out: rotation in rad within the step
};

/// True if all numbers are finite and within kLargestSoft, and the rotation has length one.
bool isValid(const SoftObstacle& obstacle);

/// A node of a body, or a weighted point between two nodes.
struct SoftPoint {
  int body = -1;
  int nodes[2] = {-1, -1};  ///< the second is −1 for a single node
  double weights[2] = {1, 0};
};

/// One contact or attachment in a sub-step: the point A is kept away from B, or attached to it.
struct SoftRow {
  std::uint64_t key = 0;  ///< constant from sub-step to sub-step while the contact lasts
  SoftPoint a;
  SoftPoint b;              ///< if body is −1, the row's obstacle replaces B
  int obstacle = -1;        ///< index in the step's span; −1: none
  Vec2 lever;               ///< position of the touched point of the obstacle relative to its centre
  Vec2 axes[2];             ///< the normal from B to A, and the tangent; x and y for an attachment
  double gaps[2] = {0, 0};  ///< along the axes at the start of the sub-step
  double friction = 0;
  bool is_attachment = false;
  double forces[2] = {0, 0};  ///< result: forces on A along the axes
  int responses[2][2] = {};   ///< index in the solver's pool of responses, by [axis][A, B]
};

/// Returns the depth of overlap that a contact may still have at the end of the sub-step. A sub-step undoes
/// only a part of the depth, and at most a part of the radius.
double lastingDepth(const SoftRow& row, double radius);

/// Force of a contact or attachment on a wide body (SoftElastic.h): an implicit spring at one or two nodes.
struct SoftPush {
  SoftRow* p_row = nullptr;
  const SoftPoint* p_own = nullptr;  ///< the side of this body
  const SoftPoint* p_other = nullptr;
  double sign = 1;  ///< −1 if this body is the row's B
  Vec2 gone;        ///< movement of the other side in this sub-step, as far as known
  double gap = 0;   ///< along the normal, without the overlap that this sub-step cannot undo
  double stiffness = 0;
  /// Along each axis: the force on A at the offsets of the last assemble(), and its decrease per movement.
  double force[2] = {0, 0};
  double yield[2] = {0, 0};
};

/// Bounds of the offsets of kSoftPatch consecutive nodes during a sub-step.
struct SoftPatch {
  Vec2 lower, upper;
};
inline constexpr int kSoftPatch = 32;

/// A body during detection: its position at the start of a sub-step, and that at the end if nothing stops it.
struct SoftView {
  const SoftBody* body = nullptr;
  int id = 0;
  const Vec2* ends = nullptr;  ///< offsets of nodes at the end if nothing stops them
  Vec2 lower, upper;           ///< bounds of both positions, radius included, relative to the body's place
  /// Only for wide bodies (SoftElastic.h): all their nodes touch rigid bodies, not only the boundary's.
  std::span<const SoftPatch> patches;
};

/// An obstacle at the start of a sub-step.
struct SoftPose {
  const SoftObstacle* obstacle = nullptr;
  int index = 0;
  Place place;
  Rotation rotation;
  Vec2 velocity;
  double spin = 0;
  double reach = 0;
};

/// Part of the radius: if the gap is smaller than this, a contact gets a row before it touches.
inline constexpr double kSoftSkin = 0.1;

/// Appends the patches of a body whose nodes move from `starts` to `ends` (by node), enlarged by `thick`.
void appendPatches(std::span<const SoftNode> starts, const Vec2* ends, double thick,
                   std::vector<SoftPatch>& patches);
/// True if a node of the patch may touch the obstacle within `h` ticks.
bool mayMeet(const SoftPatch& patch, const SoftBody& body, const SoftPose& rigid, double h);
/// True if the bounds of two bodies overlap within the sub-step.
bool mayMeet(const SoftView& a, const SoftView& b);
/// Appends rows for contacts of a soft body with an obstacle that may occur within `h` ticks.
void findContacts(const SoftView& soft, const SoftPose& rigid, double h, std::vector<SoftRow>& rows);
/// Appends rows for contacts of nodes of `a` with the boundary of `b`.
void findContacts(const SoftView& a, const SoftView& b, std::vector<SoftRow>& rows);

/// Returns the part of a node's path from `from` to `to` (offsets from the body's place) up to the obstacle;
/// 1 if it does not hit, or starts inside. This is the time of impact for nodes: a ray per shape, in the
/// obstacle's axes (ShapeQuery.h).
double freeFraction(const SoftBody& body, Vec2 from, Vec2 to, const SoftPose& rigid, double h);

}  // namespace naiad::physics
