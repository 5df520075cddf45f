// A rope of rods between centres: RATTLE as in JointIsland, in two passes along the rope per iteration.
//
// The pass down the rope moves, measures and does the forward half of the solution; the pass back does the
// other half and applies the impulses. x and y are calculated in parallel. This needs a third of the
// instructions of the general method.
#pragma once

#include <span>
#include <vector>

#include "physics/geometry/Vec2.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {

class JointChain {
 public:
  enum class Status : std::uint8_t {
    kDone,
    kSlow,  ///< a stage did not converge
    kBad    ///< the rods are nearly dependent, so this method cannot solve the equations
  };
  struct Rod {
    int a, b;
    double square, half_inverse_length;
  };

  /// Sets the rods, in an order in which each shares a movable body with the next one, and with no other rod.
  void connect(std::span<const Rod> rods, std::span<const JointMass> masses);
  bool isEmpty() const { return m_rods.empty(); }

  /// Sets the state. The spans are by body, `multiplier` is by rod and per unit of time.
  void load(std::span<const Vec2> place, std::span<const Vec2> velocity, std::span<const Vec2> acceleration,
            std::span<const double> multiplier, double tolerance);
  /// Projects the velocities onto those that the rods allow.
  Status project();
  /// Advances by a stage of length h != 0. If the result is not kDone, call load() again.
  Status stage(double h, std::uint64_t& iterations);
  /// Writes the results. `multiplier` is per unit of time. Entry index_of[rod] of `force` is the sum of the
  /// rod's impulses on its body b.
  void store(std::span<Vec2> place, std::span<Vec2> velocity, std::span<double> multiplier,
             std::span<Vec2> force, std::span<const int> index_of) const;

 private:
  using Pair = double __attribute__((vector_size(16)));
  struct Node {
    Pair place, before, velocity, acceleration;
    double inverse_mass;
    int body;
  };
  struct Link {
    Pair direction;  // from this node to the next, divided by the length
    Pair force;
    double square, half_inverse_length;
    double multiplier, last_multiplier;
    double rest;
    double lower, inverse;  // entries of the factored matrix
    bool is_backward;       // b is the first body
  };

  static double dot(Pair a, Pair b) {
    const Pair product = a * b;
    return product[0] + product[1];
  }
  static void push(Node* p_node, const Link& rod, double impulse) {
    const Pair push = impulse * rod.direction;
    p_node[0].velocity -= p_node[0].inverse_mass * push;
    p_node[1].velocity += p_node[1].inverse_mass * push;
  }
  Status finish(double h, double half);
  bool iterateNewton(double h, std::uint64_t& iterations);

  std::vector<Node> m_nodes;
  std::vector<Link> m_rods;
  double m_tolerance = 0;
  double m_last_h = 0;
};

}  // namespace naiad::physics
