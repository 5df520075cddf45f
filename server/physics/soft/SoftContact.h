// Where soft bodies touch rigid ones and one another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Place.h"
#include "physics/geometry/Rotation.h"
#include "physics/soft/SoftBody.h"

namespace naiad::physics {

/// A rigid body as soft ones see it during one step. Inside the step it moves by its velocity, acceleration
/// and what the soft bodies do to it; what they did is added to the outputs, for the layer that owns it to
/// apply.
struct SoftObstacle {
  int id = 0;  ///< the caller's, unique in a step: what attachments and events name
  std::span<const ConvexShape> shapes;
  Place place;  ///< of the centre of mass, which is the shapes' origin
  Rotation rotation;
  Vec2 velocity;      ///< per tick
  double spin = 0;    ///< rad per tick
  Vec2 acceleration;  ///< by all that is not soft, so that rest is rest within the step too
  double inverse_mass = 0;
  double inverse_inertia = 0;
  double friction = 0;

  Vec2 impulse;                ///< out: mass · cells per tick
  double angular_impulse = 0;  ///< out: about the centre of mass
  Vec2 displacement;           ///< out: how far it went within the step
  double turn = 0;             ///< out: rad
};

/// Finite, and no larger than a soft body may be?
bool isSound(const SoftObstacle& obstacle);

/// Up to two nodes of a body with weights: a node, or a point between two.
struct SoftPoint {
  int body = -1;
  int nodes[2] = {-1, -1};  ///< the second may be −1
  double weights[2] = {1, 0};
};

/// One contact (or one attachment) of a sub-step: A is kept away from B, or held to it.
struct SoftRow {
  std::uint64_t key = 0;  ///< the same in the next sub-step while the contact lasts
  SoftPoint a;
  SoftPoint b;              ///< body −1: an obstacle
  int obstacle = -1;        ///< index in the step's span
  Vec2 lever;               ///< of the obstacle's point from its centre
  Vec2 axes[2];             ///< normal, from B to A, and tangent; an attachment's are x and y
  double gaps[2] = {0, 0};  ///< at the start of the sub-step, along the axes
  double friction = 0;
  bool is_attachment = false;
  double forces[2] = {0, 0};  ///< on A along the axes; found
  int responses[2][2] = {};   ///< [axis][A, B] index in the solver's pool
};

/// How deep a contact may still be at the end of the sub-step: what is too deep comes out by a part of its
/// depth, and by no more than a part of the radius.
double lastingDepth(const SoftRow& row, double radius);

/// What a contact or an attachment does to a wide body: an implicit spring at one or two of its nodes.
struct SoftPush {
  SoftRow* p_row = nullptr;
  const SoftPoint* p_own = nullptr;  ///< the side that the body itself is
  const SoftPoint* p_other = nullptr;
  double sign = 1;  ///< −1: it is the row's B
  Vec2 gone;        ///< the other side's movement in this sub-step, as far as it is known
  double gap = 0;   ///< along the normal, less what is too deep to be made good in this sub-step
  double stiffness = 0;
  /// Along each axis: its force on A at the offsets of the last assembly, and less of it per movement.
  double force[2] = {0, 0};
  double yield[2] = {0, 0};
};

/// kSoftPatch nodes in order, and where they are and go within a sub-step (offsets).
struct SoftPatch {
  Vec2 lower, upper;
};
inline constexpr int kSoftPatch = 32;

/// A body as detection sees it: where it is at the start of a sub-step, and would be at its end.
struct SoftView {
  const SoftBody* body = nullptr;
  int id = 0;
  const Vec2* ends = nullptr;  ///< offsets of nodes at the end, if nothing stops them
  Vec2 lower, upper;           ///< around both, radius included, from the body's place
  /// Of a wide body (SoftElastic.h). All its nodes touch rigid bodies, not those of its boundary alone.
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

/// Of a radius: contacts closer than this get a row before they touch.
inline constexpr double kSoftSkin = 0.1;

/// Appends the patches of a body whose nodes go from `starts` to `ends`, both by node, to grow by `thick`.
void appendPatches(std::span<const SoftNode> starts, const Vec2* ends, double thick,
                   std::vector<SoftPatch>& patches);
/// May something of the patch touch the obstacle within `h` ticks?
bool mayMeet(const SoftPatch& patch, const SoftBody& body, const SoftPose& rigid, double h);
/// Do the bounds of two bodies overlap within the sub-step?
bool mayMeet(const SoftView& a, const SoftView& b);
/// Append what may touch within `h` ticks.
void findContacts(const SoftView& soft, const SoftPose& rigid, double h, std::vector<SoftRow>& rows);
/// Nodes of `a` against the boundary of `b`.
void findContacts(const SoftView& a, const SoftView& b, std::vector<SoftRow>& rows);

/// The part of a node's path from `from` to `to` (offsets from the body's place) that is free of the
/// obstacle; 1 if all is, or if it starts in it. The time-of-impact finder for nodes: a ray per shape, in the
/// obstacle's axes (ShapeQuery.h).
double freeFraction(const SoftBody& body, Vec2 from, Vec2 to, const SoftPose& rigid, double h);

}  // namespace naiad::physics
