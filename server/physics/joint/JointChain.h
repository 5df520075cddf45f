// A rope of rods between centres: RATTLE as JointIsland does it, in two passes along the rope per iteration.
//
// Moving, measuring and the forward half of the solution go down the rope together, the other half and the
// impulses come back up; x and y go side by side. That is a third of the general method's instructions.
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
    kBad    ///< the rods nearly depend on one another: not for this method
  };
  struct Rod {
    int a, b;
    double square, half_inverse_length;
  };

  /// `rods` in an order in which each one shares a movable body with the next one, and with no other.
  void connect(std::span<const Rod> rods, std::span<const JointMass> masses);
  bool isEmpty() const { return m_rods.empty(); }

  /// By body; `multiplier` by rod, per unit of time.
  void load(std::span<const Vec2> place, std::span<const Vec2> velocity, std::span<const Vec2> acceleration,
            std::span<const double> multiplier, double tolerance);
  /// Takes out of the velocities what the rods do not allow.
  Status project();
  /// A stage over h != 0. After anything but kDone, load again.
  Status stage(double h, std::uint64_t& iterations);
  /// `multiplier` per unit of time; `force` sums the impulses on b, and is by what `place_of` says of a rod.
  void store(std::span<Vec2> place, std::span<Vec2> velocity, std::span<double> multiplier,
             std::span<Vec2> force, std::span<const int> place_of) const;

 private:
  using Pair = double __attribute__((vector_size(16)));
  struct Node {
    Pair place, before, velocity, acceleration;
    double inverse_mass;
    int body;
  };
  struct Link {
    Pair direction;  // from this node to the next one, over the length
    Pair force;
    double square, half_inverse_length;
    double multiplier, last_multiplier;
    double rest;
    double lower, inverse;  // of the factored matrix
    bool is_backward;       // b comes first
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
  bool newton(double h, std::uint64_t& iterations);

  std::vector<Node> m_nodes;
  std::vector<Link> m_rods;
  double m_tolerance = 0;
  double m_last_h = 0;
};

}  // namespace naiad::physics
