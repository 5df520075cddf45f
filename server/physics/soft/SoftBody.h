// Data of a soft body: mass points connected by springs, with stiffness in physical units.
//
// Time is in ticks, lengths in metric cells, mass in the game's unit. So a stretch stiffness k is in mass per
// tick², EA in mass · cell per tick² and EI in mass · cell³ per tick². SoftBuild.h makes the usual bodies.
#pragma once

#include <cmath>
#include <vector>

#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"

namespace naiad::physics {

struct SoftNode {
  Vec2 offset;  ///< relative to the body's place
  Vec2 velocity;
  Vec2 force;       ///< external force in addition to gravity; acts until it is changed
  double mass = 1;  ///< > 0
  /// True if forces do not move the node: it stays, or continues with its velocity.
  bool is_pinned = false;
};

/// A spring between two nodes: force = stiffness · (distance − rest length) + damping · rate of the distance.
struct SoftStretch {
  int a = 0;
  int b = 0;
  double rest_length = 1;  ///< > 0
  double stiffness = 1;    ///< EA / rest length for a bar; >= 0
  double damping = 0;      ///< >= 0
  /// Limit of strain, > 0: beyond it a spring is taut, and kTautSoft · stiffness is added. 0: no limit.
  double limit = 0;
};

/// A spring against bending at node b of the corner a, b, c: moment = stiffness · (angle − rest angle) +
/// damping · rate of the angle. The angle is 0 for a straight corner.
struct SoftBend {
  int a = 0;  ///< −1: a clamp, for which `direction` replaces the direction from a to b
  int b = 0;
  int c = 0;
  double rest_angle = 0;  ///< −π … π
  double stiffness = 1;   ///< EI divided by the length of beam that this corner represents; >= 0
  double damping = 0;     ///< >= 0
  Vec2 direction = {1, 0};
};

struct SoftBody {
  Place place;
  std::vector<SoftNode> nodes;  ///< 1 … kMaxSoftNodes
  std::vector<SoftStretch> stretches;
  std::vector<SoftBend> bends;
  /// The surface that other bodies touch: nodes in order, with straight lines between neighbours. If it is
  /// closed, it has an inside, and is ordered from x to y (clockwise on the screen).
  std::vector<int> boundary;
  bool is_closed = false;
  double radius = 0.1;  ///< radius of nodes and lines of the boundary in contacts; > 0
  double friction = 0;  ///< >= 0; a pair has the geometric mean of its two
  double drag = 0;      ///< per tick: the speed of a free node decays as exp(−drag · t); >= 0
  /// The inside of the boundary presses outwards with `pressure` + `bulk` · (1 − area / rest_area).
  double pressure = 0;   ///< force per length
  double bulk = 0;       ///< force per length; >= 0
  double rest_area = 0;  ///< > 0 if pressure or bulk is not 0
};

inline constexpr int kMaxSoftNodes = 16'384;  ///< limit of nodes; SoftElastic.h describes the cost of a tick
inline constexpr double kTautSoft = 100;      ///< stiffness added beyond the limit, over that of the stretch
inline constexpr double kLargestSoft = 1e12;  ///< limit of sizes, speeds, masses, forces and stiffness
/// True if |x| is within kLargestSoft; false for NaN.
inline bool isSmallSoft(double x) {
  return std::fabs(x) <= kLargestSoft;
}
inline bool isSmallSoft(Vec2 v) {
  return isSmallSoft(v.x) && isSmallSoft(v.y);
}

/// True if the body is valid: all numbers finite and within kLargestSoft, indices in range, no sizes of zero,
/// and gas only in a closed boundary.
bool isValid(const SoftBody& body);

/// Returns the body's energy: the kinetic energy, that of the springs and the pressure, and −force · offset
/// for gravity and the nodes' forces.
double energyOf(const SoftBody& body, Vec2 gravity);

}  // namespace naiad::physics
