// Contacts as rows of a step of soft sub-steps, four pairs of bodies in parallel.
//
// Each sub-step first solves velocities with soft contacts, which push overlap out like a damped spring.
// After the bodies have moved it solves without that push, so that the speed it caused does not remain ("soft
// step" with relaxation: E. Catto, "Solver2D", 2024; the softness: "Soft constraints", 2011). A contact with
// a gap allows its bodies to close the gap, but no more. Numbers are relative to the pair and do not include
// the common speed of two bodies.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/Manifold.h"
#include "physics/substep/Lanes.h"
#include "physics/substep/Softness.h"
#include "physics/substep/SubstepBody.h"

namespace naiad::physics {

/// Input of one contact for a step. At most one of its bodies is immovable.
struct ContactRow {
  std::int32_t a = 0, b = 0;  ///< indices of states
  float inverse_mass_a = 0, inverse_mass_b = 0, inverse_inertia_a = 0, inverse_inertia_b = 0;
  Vec2 velocity;  ///< velocity of b's centre relative to a's, at the start of the step
  float friction = 0, restitution = 0;
  float max_push = 0;            ///< maximum speed at which overlap is undone
  float rest = 0;                ///< impacts slower than this do not bounce
  float spin_a = 0, spin_b = 0;  ///< spins at the start of the step
  Vec2 driver;                   ///< velocity of the immovable body, if is_driven
  bool is_held = false;          ///< one of the bodies is immovable, so that the row is stiffer
  bool is_driven = false;        ///< the immovable body moves
  bool is_given = false;         ///< its normal impulses are given (setNormalImpulse()), not solved for
  bool is_lasting = false;       ///< carries a resting load: own softness, and its impulses have a trend
  float fast = 1e9f;             ///< approaches faster than this are stopped at once
};

/// An impulse as known from earlier sub-steps.
struct KnownImpulse {
  float kept = 0;   ///< first guess in the next sub-step
  float trend = 0;  ///< recent changes of the impulse, with less weight for older ones
};

/// Impulses of both points of a contact; 0 for a missing point.
struct KnownImpulses {
  std::array<KnownImpulse, 2> normal = {}, friction = {};
};

/// Result of a contact in a step.
struct ContactPush {
  float total = 0;   ///< impulse of both points
  float first = -1;  ///< time of the first impulse within the step; < 0: none
};

class ContactRows {
 public:
  /// Starts a step whose sub-steps have the length `h`, and reserves memory for this many blocks.
  void clear(std::size_t blocks, float h);
  /// Begins a block of at most kLanes rows that have no movable body in common.
  void beginBlock();
  /// Ends the block; no further rows may be added to it.
  void finishBlock();
  /// Adds a row; returns its number for read().
  std::int32_t add(const ContactRow& row, const Manifold& manifold, const KnownImpulses& known);

  void warmStart(std::span<SubstepState> states);
  /// Solves velocities. `time` is since the step began. `is_soft` is true before the bodies move.
  void solve(std::span<SubstepState> states, float h, float time, bool is_soft) {
    is_soft ? solveRows<true>(states, h, time) : solveRows<false>(states, h, time);
  }
  /// Call after the last sub-step: applies restitution to contacts that approached fast enough.
  void bounce(std::span<SubstepState> states);
  bool mayBounce() const { return m_may_bounce; }
  /// Returns the impulse at a point of a row in this sub-step.
  float normalImpulse(std::int32_t row, int point) const;
  void setNormalImpulse(std::int32_t row, int point, float impulse);
  /// Returns the speed with which a point is to separate by restitution; 0: it does not bounce.
  float bounceSpeed(std::int32_t row, int point) const;
  /// Calls visit(state, work) for the contacts with moving immovable bodies: the work of their impulses in
  /// this sub-step on the other body.
  template <class Visit>
  void visitWork(Visit visit) const {
    for (const Driven& driven : m_driven) visit(driven.state, workOf(driven));
  }
  /// Multiplies the impulses of each contact by the factor of its movable body's state.
  void scale(std::span<const float> factors);
  /// Call after the last sub-step: returns the result, and sets `known` for the next step.
  ContactPush read(std::int32_t row, KnownImpulses& known) const;
  std::size_t blocks() const { return m_blocks.size(); }

 private:
  template <bool kIsSoft>
  void solveRows(std::span<SubstepState> states, float h, float time);

  struct Impulse {
    Lanes now = {};
    Lanes start = {};  // at the start of the sub-step
    Lanes trend = {};  // as in KnownImpulse
    void set(int lane, KnownImpulse known);
    void begin();  // call when all lanes are set
    KnownImpulse known(int lane) const;
    void beginSubstep(Lanes least, Lanes most, Lanes most_trend);
  };
  struct Point {
    Lanes ax = {}, ay = {}, bx = {}, by = {};  // levers about the centres of a and b
    Lanes gap = {};                            // gap at the start of the step
    Lanes gap_now = {};                        // gap after the bodies last moved
    Lanes normal_mass = {}, tangent_mass = {};
    Impulse normal, friction;
    Lanes total = {};
    Lanes approach = {};  // normal speed at the start of the step, if the block bounces
  };
  struct Block {
    std::array<std::int32_t, kLanes> a = {}, b = {};
    std::int32_t count = 0;
    std::int32_t points = 0;  // 2 if any row has two points
    Lanes inverse_mass_a = {}, inverse_mass_b = {}, inverse_inertia_a = {}, inverse_inertia_b = {};
    Lanes nx = {}, ny = {}, vx = {}, vy = {};
    Lanes spin_a = {}, spin_b = {};                        // spins at the start of the step
    Lanes rate = {}, mass_scale = {}, impulse_scale = {};  // Softness of the rows
    Lanes friction = {}, restitution = {}, max_push = {}, rest = {}, fast = {};
    Lanes follows = {};              // 1 if the row's impulses have a trend, else 0
    Lanes first = {-1, -1, -1, -1};  // time of the first impulse
    bool bounces = false;            // true if any row bounces
    std::array<Point, 2> point;
  };
  struct Driven {             // a contact with a moving immovable body
    std::int32_t row, state;  // the state is that of the other body
    Vec2 velocity;
    double spin;
    bool is_a;  // the immovable body is a
  };
  double workOf(const Driven& driven) const;
  static void updateGaps(Block& block, std::span<const SubstepState> states, float time);
  std::vector<Block> m_blocks;
  std::vector<Driven> m_driven;
  bool m_may_bounce = false;
  std::array<Softness, 2> m_softness, m_lasting_softness;  // index 1: for contacts with an immovable body
};

}  // namespace naiad::physics
