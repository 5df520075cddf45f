// Watches that impulses add no kinetic energy to a group of bodies, except what drivers and springs give.
//
// Impulses known from the last sub-step, the push that undoes overlap, and restitution may increase the
// kinetic energy of a group. Then one factor scales the velocities of its bodies, relative to the motion of a
// rigid body with the group's momentum and angular momentum, or relative to the world if an immovable body
// pushed the group. So contacts do not approach again, and the impulses that carry a pile remain. In a group
// with joints, energy may pass from a heavy body to light ones, so the factor scales the velocity changes of
// the stage. Groups do not influence each other: each is checked alone, in its own frame.
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
  /// Starts a step with this many states. Only those for which watch() or hold() is called take part.
  void begin(std::size_t states);
  void watch(std::int32_t state) { m_marks[at(state)] |= kWatched; }
  /// Marks a body that touches or is joined to an immovable one. The group's frame is then the world's.
  void hold(std::int32_t state) { m_marks[at(state)] |= kWatched | kHeld; }
  /// True if the body was slowed in this step, which may have moved momentum between bodies of its group.
  bool isSlowed(std::int32_t state) const { return (m_marks[at(state)] & kSlowed) != 0; }
  /// Returns the first slowed body of its group.
  std::int32_t firstSlowedOf(std::int32_t state) const { return m_groups[at(groupOf(state))].first_slowed; }
  bool isWatched(std::int32_t state) const { return m_marks[at(state)] != 0; }
  /// Marks a body with a joint.
  void join(std::int32_t state) { m_marks[at(state)] |= kWatched | kJointed; }
  bool isJoined(std::int32_t state) const { return (m_marks[at(state)] & kJointed) != 0; }
  /// Excludes the body's group, because it is in a crowd, from which only speed frees the bodies.
  void ignore(std::int32_t state) { m_marks[at(state)] |= kIgnored; }
  /// Sets a body's motion, mass, inertia and group, which is the lowest state of its members. Call for all
  /// that are watched.
  void set(std::int32_t state, const RigidBody& body, double mass, double inertia, std::int32_t group);
  /// Starts the sub-steps of these states, of whole groups, in ascending order.
  void beginBatch(std::span<const std::int32_t> states);
  /// Returns the body's velocity at the start of the step, in the group's frame.
  Vec2 velocity(std::int32_t state) const { return m_velocities[at(state)]; }
  double mass(std::int32_t state) const { return m_members[at(state)].mass; }

  /// Starts a stage of impulses on this body, which has this gained velocity and spin.
  void note(std::int32_t state, Lanes speeds) { m_members[at(state)].before = speeds; }
  /// Starts a stage of impulses on all bodies of the batch.
  void note(std::span<const SubstepState> states) {
    for (const std::int32_t id : m_ids) note(id, speedsOf(states[at(id)]));
  }
  /// Adds energy given to the group of this body in this stage, by impulses or from springs.
  void giveByImpulses(std::int32_t state, double work) { m_groups[at(groupOf(state))].gain -= work; }
  void giveFromSprings(std::int32_t state, double work) {
    m_groups[at(groupOf(state))].gain -= work;
    m_groups[at(groupOf(state))].given += work;
  }
  /// Ends a stage, at this time since the step began: slows the groups that gained energy. Returns true if
  /// factors() are not all 1. In a bounce, a group may gain what its earlier impulses in this step took away.
  bool balance(std::span<SubstepState> states, double time, bool is_bounce);
  /// Returns the factors of velocity changes in the last balance(), by state.
  std::span<const float> factors() const { return m_factors; }
  /// Returns how many groups gained considerable energy, since construction.
  std::int64_t scaled() const { return m_scaled; }

 private:
  struct Motion {
    Vec2 velocity;
    double spin = 0;
  };
  struct Rigid {  // motion of a group as one rigid body
    double mass = 0, inertia = 0;
    double pushed = 0;  // sum of the impulses on the bodies in this stage
    Vec2 middle;
    Motion before, after;  // before and after this stage
  };
  struct Group {
    double gain = 0;      // energy gained in this stage beyond what was given
    double over = 0;      // gain that it may not have
    double given = 0;     // energy given by springs in this stage
    double lost = 0;      // energy taken by impulses in this step
    double twice = 0;     // twice the energy of the motion that is slowed
    double rounding = 0;  // largest rounding error of the gain
    double factor = 1;
    std::int32_t first_slowed = 0;
    Rigid rigid;
  };
  static constexpr std::uint8_t kWatched = 1, kHeld = 2, kIgnored = 4, kJointed = 8, kSlowed = 16;
  struct alignas(64) Member {
    Lanes before = {};  // gained velocity and spin before the impulses of this stage
    Lanes twice = {};   // twice the velocity at the start of the step, in the group's frame
    double mass = 0, inertia = 0;
    std::int32_t group = 0;
  };
  static Lanes speedsOf(const SubstepState& state) {
    Lanes speeds;
    __builtin_memcpy(&speeds, &state.vx, sizeof speeds);
    return speeds;
  }
  // Returns the lowest state of the body's group.
  std::int32_t groupOf(std::int32_t state) const { return m_members[at(state)].group; }
  // Returns the motion with these gained speeds, in the group's frame.
  Motion motionOf(std::int32_t state, Lanes speeds) const {
    return {m_velocities[at(state)] + Vec2{speeds[0], speeds[1]}, speeds[2]};
  }
  // Returns the place in the group's frame, relative to the start of its lowest member.
  Vec2 placeOf(std::int32_t state, std::span<const SubstepState> states, double time) const {
    const SubstepState& s = states[at(state)];
    return (m_places[at(state)] - m_places[at(groupOf(state))]) + time * m_velocities[at(state)] +
           Vec2{s.x, s.y};
  }
  void sum(std::span<const SubstepState> states);
  bool judge(bool is_bounce);
  template <class Visit>
  void visitOver(std::span<const SubstepState> states, Visit visit);
  void findRigidMotions(std::span<const SubstepState> states, double time);
  static double factorOf(Group& group, bool is_jointed, bool is_bounce);
  void slow(std::span<SubstepState> states, double time, bool is_bounce);

  std::vector<Member> m_members;   // by state
  std::vector<Vec2> m_velocities;  // by state
  std::vector<Place> m_places;     // by state
  std::vector<float> m_factors;    // by state
  bool m_has_factors = false;
  std::vector<std::uint8_t> m_marks;  // by state
  std::vector<Group> m_groups;        // by lowest state
  std::vector<std::int32_t> m_ids;    // watched states of this batch
  std::vector<std::int32_t> m_roots;  // their groups
  std::int64_t m_scaled = 0;
};

}  // namespace naiad::physics
