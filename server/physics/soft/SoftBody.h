// What a soft body is: mass points, and what holds them together, with stiffness in physical units.
//
// Time counts in ticks, lengths in metric cells, mass in the game's unit. So a stretch stiffness k is mass
// per tick², EA mass · cell per tick² and EI mass · cell³ per tick². SoftBuild.h makes the usual bodies.
#pragma once

#include <cmath>
#include <vector>

#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"

namespace naiad::physics {

struct SoftNode {
  Vec2 offset;  ///< from the body's place
  Vec2 velocity;
  Vec2 force;       ///< what pulls at it besides gravity, until it is set otherwise
  double mass = 1;  ///< > 0
  /// Nothing pushes it: it stays, or goes on with its velocity.
  bool is_pinned = false;
};

/// A spring between two nodes: force = stiffness · (distance − rest length) + damping · its rate.
struct SoftStretch {
  int a = 0;
  int b = 0;
  double rest_length = 1;  ///< > 0
  double stiffness = 1;    ///< EA / rest length for a bar; >= 0
  double damping = 0;      ///< >= 0
  /// Of strain, > 0: stretched further, it is taut, and kTautSoft times as stiff. 0: it never is.
  double limit = 0;
};

/// A spring against bending at b, in the corner a, b, c: moment = stiffness · (angle − rest angle) + damping
/// · its rate. The angle is 0 where the corner is straight.
struct SoftBend {
  int a = 0;  ///< −1: a clamp; `direction` then stands for the direction from a to b
  int b = 0;
  int c = 0;
  double rest_angle = 0;  ///< −π … π
  double stiffness = 1;   ///< EI / length of beam that this corner stands for; >= 0
  double damping = 0;     ///< >= 0
  Vec2 direction = {1, 0};
};

struct SoftBody {
  Place place;
  std::vector<SoftNode> nodes;  ///< 1 … kMaxSoftNodes
  std::vector<SoftStretch> stretches;
  std::vector<SoftBend> bends;
  /// What others touch: nodes in order, with straight lines between neighbours. Closed, it has an inside, and
  /// runs in the sense from x to y.
  std::vector<int> boundary;
  bool is_closed = false;
  double radius = 0.1;  ///< of the nodes and of the lines between them, where others touch them; > 0
  double friction = 0;  ///< >= 0; of a pair the geometric mean counts
  double drag = 0;      ///< per tick: a free node's speed falls as exp(−drag · t); >= 0
  /// The boundary's inside presses outwards with `pressure` + `bulk` · (1 − area / rest_area).
  double pressure = 0;   ///< force per length
  double bulk = 0;       ///< the same; >= 0
  double rest_area = 0;  ///< > 0 if there is pressure or bulk
};

inline constexpr int kMaxSoftNodes = 16'384;  ///< a tick's cost: SoftElastic.h
inline constexpr double kTautSoft = 100;      ///< of a stretch beyond its limit, over its stiffness
inline constexpr double kLargestSoft = 1e12;  ///< of sizes, speeds, masses, forces and stiffness
/// False for NaN.
inline bool isSmallSoft(double x) {
  return std::fabs(x) <= kLargestSoft;
}
inline bool isSmallSoft(Vec2 v) {
  return isSmallSoft(v.x) && isSmallSoft(v.y);
}

/// May it be taken in? Everything finite and within kLargestSoft, indices in range, nothing of zero size.
bool isSound(const SoftBody& body);

/// Kinetic energy, that of the springs and the pressure, and −force · offset for gravity and the nodes'
/// forces.
double energyOf(const SoftBody& body, Vec2 gravity);

}  // namespace naiad::physics
