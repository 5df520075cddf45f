// The joints of rigid bodies as velocity constraints, solved together with the contacts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/JointRows.h"
#include "physics/joint/JointStore.h"
#include "physics/rigid/RigidBody.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

/// A row in one half of a sub-step: (J·v − target) + softness · (impulse of this half) = 0.
struct RigidRowHalf {
  double target = 0;
  double softness = 0;
  double mass = 0;           ///< effective mass, 1 / (J·M⁻¹·Jᵀ + softness); 0: this half is finished
  double low = 0, high = 0;  ///< bounds of the impulse since the sub-step began
  double given = 0;          ///< impulse that does not depend on the velocities
};

/// One scalar constraint on two bodies.
struct RigidRow : SpeedRow {
  std::int32_t a = -1, b = -1;        ///< a is −1 for a mouse
  double inverse_effective_mass = 0;  ///< J·M⁻¹·Jᵀ
  bool is_soft = false;               ///< starts from impulse 0
  double impulse = 0;                 ///< this sub-step so far; between sub-steps, the last one
  double before = 0;                  ///< impulse of the first half, during the second
  double warm = 0;                    ///< initial guess of each half
  std::array<RigidRowHalf, 2> half;
};

class RigidJoints : public JointStore {
 public:
  /// Makes rows for the joints with an active body.
  template <class IsActive>
  void begin(std::span<const RigidBody> bodies, std::span<const RigidState> states, double h,
             IsActive isActive) {
    m_rows.clear();
    m_links.clear();
    for (const int id : ids()) {
      const Joint& j = joint(id);
      if (!j.is_broken && (isActive(j.b) || (firstOf(j) >= 0 && isActive(j.a)))) load(id, bodies);
    }
    for (RigidRow& row : m_rows) row.impulse *= h;
    refresh(states);
  }
  void refresh(std::span<const RigidState> states);
  void beginFirstHalf(std::span<RigidState> states, double h);
  void beginSecondHalf(std::span<RigidState> states, double h);
  /// Returns the rows of the joint that visitLinks() visits as number `link`.
  std::span<RigidRow> rowsOfLink(int link) {
    const Link& l = m_links[static_cast<std::size_t>(link)];
    return std::span(m_rows).subspan(static_cast<std::size_t>(l.row), static_cast<std::size_t>(l.count));
  }
  bool isSoft(int link) const {
    return m_rows[static_cast<std::size_t>(m_links[static_cast<std::size_t>(link)].row)].is_soft;
  }
  double solve(int link, std::span<RigidState> states, bool is_second);
  /// Makes the velocities that undo overlap compatible with the joints.
  void hold(std::span<RigidState> states) const;
  void endSubstep();
  /// Writes forces; returns the number of joints that broke.
  int end(double dt, double h);
  /// Calls visit(a, b) for every joint of this step; a is −1 for a mouse.
  template <class Visit>
  void visitLinks(Visit visit) const {
    for (const Link& link : m_links) visit(link.a, link.b);
  }

  std::span<const RigidRow> rows() const { return m_rows; }

 private:
  struct Link {  // a joint within a step
    int id;
    JointKind kind;
    std::int32_t a, b;
    int row, count;
    Vec2 arm_a, arm_b;  // at the start of the step
    Vec2 offset;        // from a to b, or from the target to b
    Vec2 axis;          // at the start of the step
    Rotation between;   // rotation of b relative to a and the reference, at the start of the step
    Vec2 force;
    double torque = 0;
  };

  void load(int id, std::span<const RigidBody> bodies);
  void prepare(double h);
  void prepareWarm(std::span<RigidState> states, double h, bool is_second);
  void place(const Link& link, const RigidState& a, const RigidState& b);

  std::vector<Link> m_links;
  std::vector<RigidRow> m_rows;
};

}  // namespace naiad::physics
