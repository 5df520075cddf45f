// Joints as rows of a step of soft sub-steps; they are solved alternately with the contacts (ContactRows.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/JointRows.h"
#include "physics/joint/JointStore.h"
#include "physics/substep/Softness.h"
#include "physics/substep/SubstepBody.h"

namespace naiad::physics {

class SubstepJoints : public JointStore {
 public:
  /// Makes rows for joints with a moving body, at the positions of the step's start; `h` is the length of a
  /// sub-step.
  void begin(std::span<SubstepBody> bodies, float h);
  bool isEmpty() const { return m_links.empty(); }
  void warmStart(std::span<SubstepState> states);
  void solveSoftly(std::span<SubstepState> states);
  /// Solves without softness at the present positions; `time` is since the step began.
  void relax(std::span<SubstepState> states, float time);
  /// Call after a step of length `dt`: writes the joints' forces. Returns the number of joints that broke.
  int end(double dt);
  /// Calls visit(a, b) for every joint of this step; a is −1 for a mouse joint.
  template <class Visit>
  void visitLinks(Visit visit) const {
    for (const Link& link : m_links) visit(link.a, link.b);
  }

 private:
  struct Row {
    float nx = 0, ny = 0, ja = 0, jb = 0;
    float speed = 0;  // speed along the row by the velocities at the start of the step
    float mass = 0;
    float value = 0;
    float bias = 0, mass_scale = 1, impulse_scale = 0;  // used by the soft solution
    float low = 0, high = 0;
    float impulse = 0;
    float target = 0;
    bool is_spring = false;  // a spring or motor: solved only before the bodies move
    bool is_angle = false;
    std::int8_t side = 0;
  };
  struct Link {
    int id;
    std::int32_t a, b;              // ids of bodies
    std::int32_t state_a, state_b;  // indices of states
    float inverse_mass_a, inverse_mass_b, inverse_inertia_a, inverse_inertia_b;
    int row, count;
    JointFrame frame;  // frame at the start of the step; its offset is from centre to centre
    Vec2 velocity;     // velocity of b's centre relative to a's, at the start of the step
    bool is_point;     // the first two rows hold a point together
    bool is_hinge;     // the joint has only these two rows
    float inverse_xx = 0, inverse_xy = 0, inverse_yy = 0;  // inverse of the matrix of these two rows
    Vec2 force;
    double torque = 0;
  };

  void stiffen(std::span<SubstepBody> bodies);
  void load(int id, std::span<const SubstepBody> bodies);
  void place(Link& link, const SubstepState& a, const SubstepState& b, float time);
  void prepare(Row& row, const Joint& joint) const;
  void solve(const Link& link, SubstepState& a, SubstepState& b, bool is_soft);
  void solvePoint(const Link& link, SubstepState& a, SubstepState& b, bool is_soft);
  static void solveRow(const Link& link, Row& row, SubstepState& a, SubstepState& b, bool is_soft);

  std::vector<Link> m_links;
  std::vector<Row> m_rows;
  Softness m_softness;
  float m_h = 1;
};

}  // namespace naiad::physics
