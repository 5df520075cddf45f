// The joints of rigid bodies as velocity constraints, solved together with the contacts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "physics/joint/JointRows.h"
#include "physics/joint/JointStore.h"
#include "physics/rigid/RigidBody.h"
#include "physics/rigid/RigidContact.h"

namespace naiad::physics {

/// A row for one half of a sub-step: (J·v − target) + softness · (impulse of this half) = 0.
struct RigidRowHalf {
  double target = 0;
  double softness = 0;
  double mass = 0;           ///< effective mass, 1 / (J·M⁻¹·Jᵀ + softness); 0: the row is not used now
  double low = 0, high = 0;  ///< bounds of the impulse since the sub-step began
  double given = 0;          ///< part of the impulse that does not depend on the velocities
};

/// One scalar constraint on two bodies.
struct RigidRow : SpeedRow {
  std::int32_t a = -1, b = -1;        ///< bodies; a is −1 for a mouse joint
  double inverse_effective_mass = 0;  ///< J·M⁻¹·Jᵀ
  bool is_soft = false;               ///< it has no first guess of its impulse
  double impulse = 0;                 ///< impulse of this sub-step so far; between sub-steps, of the last one
  double before = 0;                  ///< impulse of the sub-step before this half: 0 in the first half
  double warm = 0;                    ///< first guess of the impulse for each half
  std::array<RigidRowHalf, 2> half;
};

class RigidJoints : public JointStore {
 public:
  /// Makes rows for the joints with at least one active body.
  template <class IsActive>
  void begin(std::span<const RigidBody> bodies, std::span<const RigidState> states, double h,
             IsActive isActive) {
    m_rows.clear();
    for (const Link& link : m_links) m_link_of[static_cast<std::size_t>(link.id)] = -1;
    m_links.clear();
    for (const int id : ids()) {
      const Joint& j = joint(id);
      if (wayOf(id) == Way::kLinkage) continue;
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
  /// Applies the first guesses of this half again, multiplied by `part`, to the velocities before the half.
  void restart(int link, std::span<RigidState> states, bool is_second, double part);
  /// Multiplies the impulses of this half by `part`, but not the velocities that they caused.
  void scale(int link, double part);
  /// Returns the energy that motors and springs may add by the impulses of this half.
  double inputOf(int link, std::span<const RigidState> states, bool is_second);
  /// Returns the rows of a joint in this step; none if no active body has it.
  std::span<RigidRow> rowsOfJoint(int id) {
    const auto i = static_cast<std::size_t>(id);
    if (i >= m_link_of.size() || m_link_of[i] < 0) return {};
    return rowsOfLink(m_link_of[i]);
  }
  /// The solver of a joint.
  enum class Way : std::uint8_t {
    kHere,     ///< RigidJoints
    kLinkage,  ///< a RigidLinkage alone, so that begin() leaves it out
    kHeld      ///< RigidJoints, together with rigid joints of its group
  };
  void setWays(std::vector<Way> ways) { m_ways = std::move(ways); }
  Way wayOf(int id) const {
    const auto i = static_cast<std::size_t>(id);
    return i < m_ways.size() ? m_ways[i] : Way::kHere;
  }
  using JointStore::finish;
  /// Makes end() leave out a joint of this step, because a RigidLinkage has solved it.
  void skip(int id) {
    const auto i = static_cast<std::size_t>(id);
    if (i < m_link_of.size() && m_link_of[i] >= 0)
      m_links[static_cast<std::size_t>(m_link_of[i])].is_done = true;
  }
  /// True if the joint has pushed in this step.
  bool hasPushed(int id) const {
    const auto i = static_cast<std::size_t>(id);
    if (i >= m_link_of.size() || m_link_of[i] < 0) return false;
    const Link& link = m_links[static_cast<std::size_t>(m_link_of[i])];
    return link.force != Vec2{} || link.torque != 0;
  }
  /// Adds the impulse of an impact to the force of a joint of this step.
  void addImpact(int id, Vec2 force, double torque) {
    const auto i = static_cast<std::size_t>(id);
    if (i >= m_link_of.size() || m_link_of[i] < 0) return;
    m_links[static_cast<std::size_t>(m_link_of[i])].force += force;
    m_links[static_cast<std::size_t>(m_link_of[i])].torque += torque;
  }
  /// Projects the velocities that undo overlap onto those that the joints allow.
  void hold(std::span<RigidState> states) const;
  void endSubstep();
  /// Writes the forces of the step to the joints. Returns the number of joints that broke.
  int end(double dt, double h);
  /// Calls visit(a, b) for every joint of this step; a is −1 for a mouse joint.
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
    Vec2 arm_a, arm_b;  // levers at the start of the step
    Vec2 offset;        // displacement from the centre of a, or the target, to the centre of b
    Vec2 axis;          // axis at the start of the step
    Rotation between;   // rotation of b relative to a, measured from the reference, at the start of the step
    Vec2 force;
    double torque = 0;
    bool is_done = false;  // end() leaves it out
  };

  void load(int id, std::span<const RigidBody> bodies);
  void prepare(double h);
  void prepareWarm(std::span<RigidState> states, double h, bool is_second);
  void place(const Link& link, const RigidState& a, const RigidState& b);

  std::vector<Way> m_ways;     // by id
  std::vector<int> m_link_of;  // index in m_links, by id; −1: none
  std::vector<Link> m_links;
  std::vector<RigidRow> m_rows;
};

}  // namespace naiad::physics
