// Watches that impulses add no kinetic energy to a group of bodies, except what drivers and springs give.
//
// Impulses known from the last sub-step, the push that undoes overlap, and restitution may all leave a group
// with more energy than it had. If so, all impulses of the stage are multiplied by one factor from 0 to 1.
// Each group is checked alone, in its own frame, so that groups do not influence each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/substep/Lanes.h"
#include "physics/substep/SubstepBody.h"

namespace naiad::physics {

class SubstepEnergy {
 public:
  /// Starts a step with this many states; set() must follow for each but the first.
  void begin(std::size_t states);
  /// Marks a body that touches or is joined to an immovable one. The group's frame is then the world's.
  void hold(std::int32_t state) { m_marks[at(state)] |= kHeld; }
  /// Excludes the body's group, because it is in a crowd, from which only speed frees the bodies.
  void ignore(std::int32_t state) { m_marks[at(state)] |= kIgnored; }
  /// Sets a body's velocity, mass, inertia and group, which is the lowest state of its members.
  void set(std::int32_t state, Vec2 velocity, double mass, double inertia, std::int32_t group);
  /// Call after the last set(): makes velocities relative to the groups' frames.
  void chooseFrames();
  /// Starts the sub-steps of these states, of whole groups.
  void beginBatch(std::span<const std::int32_t> states);
  /// Returns the body's velocity at the start of the step, in the group's frame.
  Vec2 velocity(std::int32_t state) const { return m_velocities[at(state)]; }
  double mass(std::int32_t state) const { return m_members[at(state)].mass; }

  /// Starts a stage of impulses on this body, which has this gained velocity and spin.
  void note(std::int32_t state, Lanes speeds) { m_members[at(state)].before = speeds; }
  /// Adds energy given to the group of this body in this stage, by impulses or from springs.
  void giveByImpulses(std::int32_t state, double work) { m_groups[at(groupOf(state))].gain -= work; }
  void giveFromSprings(std::int32_t state, double work) {
    m_groups[at(groupOf(state))].gain -= work;
    m_groups[at(groupOf(state))].given += work;
  }
  /// Ends a stage: scales the velocity changes of groups that gained energy. Returns true if factors() are
  /// not all 1. In a bounce, the group may gain what its earlier impulses in this step took away.
  bool balance(std::span<const std::int32_t> ids, std::span<SubstepState> states, bool is_bounce);
  /// Returns the factors of the last balance(), by state.
  std::span<const float> factors() const { return m_factors; }
  /// Returns how many groups gained considerable energy, since construction.
  std::int64_t scaled() const { return m_scaled; }

 private:
  struct Group {
    double gain = 0;      // energy gained in this stage beyond what was given
    double given = 0;     // energy given by springs in this stage
    double lost = 0;      // energy taken by impulses in this step
    double square = 0;    // twice the energy of the velocity changes
    double rounding = 0;  // largest rounding error of the gain
    float factor = 1;
    bool is_over = false;
  };
  static constexpr std::uint8_t kHeld = 1, kIgnored = 2;
  struct alignas(64) Member {
    Lanes before = {};  // gained velocity and spin before the impulses of this stage
    Lanes twice = {};   // twice the velocity at the start of the step, in the group's frame
    double mass = 0, inertia = 0;
    std::int32_t group = 0;
  };
  std::int32_t groupOf(std::int32_t state) const { return m_members[at(state)].group; }
  void sum(std::span<const std::int32_t> ids, std::span<const SubstepState> states);
  bool judge(bool is_bounce);
  void scale(std::span<const std::int32_t> ids, std::span<SubstepState> states, bool is_bounce);

  std::vector<Member> m_members;      // by state
  std::vector<Vec2> m_velocities;     // by state
  std::vector<std::uint8_t> m_marks;  // by state
  std::vector<Group> m_groups;        // by lowest state
  std::vector<std::int32_t> m_roots;  // groups of this batch
  std::vector<float> m_factors;       // by state
  bool m_has_factors = false;
  std::int64_t m_scaled = 0;
};

}  // namespace naiad::physics
