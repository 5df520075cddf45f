// Contacts as rows of a step of soft sub-steps, four pairs of bodies side by side.
//
// Each sub-step first solves for velocities with soft contacts, which push overlap out as a damped spring
// would, then, where the bodies have moved, without that push, so that it leaves no speed behind ("soft step"
// with relaxation: E. Catto, "Solver2D", 2024; the softness: "Soft constraints", 2011). A contact that is
// still a gap lets its bodies close it and no more. Numbers are relative to the pair: the speed that two
// bodies have in common is in none of them.
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

/// What a step of one contact starts from; one side of it may be immovable.
struct ContactRow {
  std::int32_t a = 0, b = 0;  ///< states
  float inverse_mass_a = 0, inverse_mass_b = 0, inverse_inertia_a = 0, inverse_inertia_b = 0;
  Vec2 velocity;  ///< of b's centre against a's, at the start of the step
  float friction = 0, restitution = 0;
  float max_push = 0;            ///< speed at which overlap is undone, at most
  float rest = 0;                ///< slower impacts do not bounce
  float spin_a = 0, spin_b = 0;  ///< at the start of the step
  bool is_held = false;          ///< an immovable body is in it: stiffer
  bool is_lasting = false;  ///< it only carries what lies still: a spring of its own, impulses with a trend
  float fast = 1e9f;        ///< what comes faster than that is stopped at once
};

/// What is known of an impulse from sub-step to sub-step.
struct KnownImpulse {
  float kept = 0;   ///< what the next sub-step starts from
  float trend = 0;  ///< by how much it has changed of late
};

/// Of both points of a contact; 0 of one that it has not.
struct KnownImpulses {
  std::array<KnownImpulse, 2> normal = {}, friction = {};
};

/// What a contact did in a step.
struct ContactPush {
  float total = 0;   ///< impulse, of both points
  float first = -1;  ///< time within the step of the first one; below 0: there was none
};

class ContactRows {
 public:
  /// For sub-steps over `h`; memory for so many blocks is taken once.
  void clear(std::size_t blocks, float h);
  /// Rows of one block have no movable body in common: at most kLanes of them, then a new block must begin.
  void beginBlock();
  /// No more rows come into it.
  void finishBlock();
  /// Returns where its impulses are read from.
  std::int32_t add(const ContactRow& row, const Manifold& manifold, const KnownImpulses& known);

  void warmStart(std::span<SubstepState> states);
  /// `time`: since the step began. Softly before bodies move, then, where they are, without softness.
  void solve(std::span<SubstepState> states, float h, float time, bool is_soft) {
    is_soft ? solveRows<true>(states, h, time) : solveRows<false>(states, h, time);
  }
  /// What came fast enough leaves as its restitution says. After the last sub-step.
  void bounce(std::span<SubstepState> states);
  /// After the last sub-step; `known` becomes what the next step starts from.
  ContactPush read(std::int32_t row, KnownImpulses& known) const;
  std::size_t blocks() const { return m_blocks.size(); }

 private:
  template <bool kIsSoft>
  void solveRows(std::span<SubstepState> states, float h, float time);

  struct Impulse {
    Lanes now = {};
    Lanes start = {};  // of the sub-step
    Lanes trend = {};  // what has been added of late, older parts less and less
    void set(int lane, KnownImpulse known);
    void begin();  // all lanes are set
    KnownImpulse known(int lane) const;
    void beginSubstep(Lanes least, Lanes most, Lanes most_trend);
  };
  struct Point {
    Lanes ax = {}, ay = {}, bx = {}, by = {};  // levers about both centres
    Lanes gap = {};                            // at the start, less what the levers say of it
    Lanes gap_now = {};                        // since bodies moved last
    Lanes normal_mass = {}, tangent_mass = {};
    Impulse normal, friction;
    Lanes total = {};
    Lanes approach = {};  // normal speed at the start of the step, if the block bounces
  };
  struct Block {
    std::array<std::int32_t, kLanes> a = {}, b = {};
    std::int32_t count = 0;
    std::int32_t points = 0;  // 2 if any row has two
    Lanes inverse_mass_a = {}, inverse_mass_b = {}, inverse_inertia_a = {}, inverse_inertia_b = {};
    Lanes nx = {}, ny = {}, vx = {}, vy = {};
    Lanes spin_a = {}, spin_b = {};                        // at the start of the step
    Lanes rate = {}, mass_scale = {}, impulse_scale = {};  // softness
    Lanes friction = {}, restitution = {}, max_push = {}, rest = {}, fast = {};
    Lanes follows = {};              // 1 if its impulses have a trend, or 0
    Lanes first = {-1, -1, -1, -1};  // time of the first impulse
    bool bounces = false;            // any of them
    std::array<Point, 2> point;
  };
  static void updateGaps(Block& block, std::span<const SubstepState> states, float time);
  std::vector<Block> m_blocks;
  std::array<Softness, 2> m_softness, m_lasting_softness;  // the second one: held
};

}  // namespace naiad::physics
