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
/// acceleration and the soft bodies' forces. The outputs sum these, and the owning layer applies them.
struct SoftObstacle {
  int id = 0;  ///< the caller's, unique in a step; attachments and events use it
  std::span<const ConvexShape> shapes;
  Place place;  ///< place of the centre of mass, the shapes' origin
  Rotation rotation;
  Vec2 velocity;      ///< per tick
  double spin = 0;    ///< rad per tick
  Vec2 acceleration;  ///< all forces over mass except those of soft bodies, so that a body at rest stays at
                      ///< rest
  double inverse_mass = 0;
  double inverse_inertia = 0;
  double friction = 0;

  Vec2 impulse;                ///< out: mass · cells per tick
  double angular_impulse = 0;  ///< out: about the centre of mass
  Vec2 displacement;           ///< out: movement within the step
  double turn = 0;             ///< out: rotation in rad within the step
};

/// True if finite and not larger than a soft body may be.
bool isSound(const SoftObstacle& obstacle);

/// A node of a body, or a weighted point between two nodes.
struct SoftPoint {
  int body = -1;
  int nodes[2] = {-1, -1};  ///< the second may be −1
  double weights[2] = {1, 0};
};

/// One contact or attachment of a sub-step: A is kept away from B, or attached to it.
struct SoftRow {
  std::uint64_t key = 0;  ///< constant from sub-step to sub-step while the contact lasts
  SoftPoint a;
  SoftPoint b;              ///< body is −1 for an obstacle
  int obstacle = -1;        ///< index in the step's span
  Vec2 lever;               ///< obstacle's point relative to its centre
  Vec2 axes[2];             ///< normal, from B to A, and tangent; x and y for an attachment
  double gaps[2] = {0, 0};  ///< along the axes at the start of the sub-step
  double friction = 0;
  bool is_attachment = false;
  double forces[2] = {0, 0};  ///< result: forces on A along the axes
  int responses[2][2] = {};   ///< [axis][A, B] index in the solver's pool
};

/// Returns the depth that a contact may still have at the end of the sub-step: overlap is undone by a part of
/// its depth, and by at most a part of the radius.
double lastingDepth(const SoftRow& row, double radius);

/// A contact's or attachment's force on a wide body: an implicit spring at one or two of its nodes.
struct SoftPush {
  SoftRow* p_row = nullptr;
  const SoftPoint* p_own = nullptr;  ///< side of this body
  const SoftPoint* p_other = nullptr;
  double sign = 1;  ///< −1: this body is the row's B
  Vec2 gone;        ///< known movement of the other side in this sub-step
  double gap = 0;   ///< along the normal, without the overlap that this sub-step cannot undo
  double stiffness = 0;
  /// Along each axis: force on A at the offsets of the last assembly, and its decrease per movement.
  double force[2] = {0, 0};
  double yield[2] = {0, 0};
};

/// Bounds of kSoftPatch consecutive nodes over a sub-step (offsets).
struct SoftPatch {
  Vec2 lower, upper;
};
inline constexpr int kSoftPatch = 32;

/// A body during detection: its position at the start of a sub-step, and its unimpeded one at the end.
struct SoftView {
  const SoftBody* body = nullptr;
  int id = 0;
  const Vec2* ends = nullptr;  ///< offsets of nodes at the end if nothing stops them
  Vec2 lower, upper;           ///< around both positions, radius included, relative to the body's place
  /// Wide bodies only (SoftElastic.h). All nodes of these touch rigid bodies, not only the boundary's.
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

/// Part of a radius: contacts closer than this get a row before they touch.
inline constexpr double kSoftSkin = 0.1;

/// Appends the patches of a body whose nodes move from `starts` to `ends` (by node), enlarged by `thick`.
void appendPatches(std::span<const SoftNode> starts, const Vec2* ends, double thick,
                   std::vector<SoftPatch>& patches);
/// True if a node of the patch may touch the obstacle within `h` ticks.
bool mayMeet(const SoftPatch& patch, const SoftBody& body, const SoftPose& rigid, double h);
/// True if the bounds of two bodies overlap within the sub-step.
bool mayMeet(const SoftView& a, const SoftView& b);
/// Appends rows for contacts that may occur within `h` ticks.
void findContacts(const SoftView& soft, const SoftPose& rigid, double h, std::vector<SoftRow>& rows);
/// Appends rows for nodes of `a` against the boundary of `b`.
void findContacts(const SoftView& a, const SoftView& b, std::vector<SoftRow>& rows);

/// Returns the part of a node's path from `from` to `to` (offsets from the body's place) before it hits the
/// obstacle; 1 if it does not, or if it starts inside. This is the time of impact of nodes: a ray per shape,
/// in the obstacle's axes (ShapeQuery.h).
double freeFraction(const SoftBody& body, Vec2 from, Vec2 to, const SoftPose& rigid, double h);

}  // namespace naiad::physics
