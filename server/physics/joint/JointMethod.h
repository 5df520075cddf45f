// How the motion of jointed bodies is advanced: RATTLE, alone or composed with itself to a higher order.
//
// RATTLE (Andersen 1983) is symmetric and symplectic of order 2; a symmetric composition of sub-steps with
// the right lengths, some of them backwards, has order 4 or 6 and keeps both properties (Suzuki 1990; Kahan
// and Li 1997; Hairer, Lubich, Wanner, "Geometric Numerical Integration", V.3). What loses energy (damping,
// ropes that catch, limits, motors) cannot run backwards, and stays with RATTLE.
#pragma once

#include <cstdint>
#include <span>

namespace naiad::physics {

enum class JointMethod : std::uint8_t {
  kAutomatic,  ///< order 4 for an island that keeps its energy (6 where a stiff spring pulls), else RATTLE
  kRattle,     ///< order 2, one sub-step per stage
  kSuzuki4,    ///< order 4, 5 stages
  kKahanLi6,   ///< order 6, 9 stages
};

struct JointOptions {
  JointMethod method = JointMethod::kAutomatic;
  int substeps =
      8;  ///< stages in a step, all in all: a composition is repeated as often as fits, at least once
};

/// The lengths of the stages of a method, their sum is 1.
std::span<const double> stagesOf(JointMethod method);
/// How often a step repeats them.
int repeatsOf(const JointOptions& options);

/// When Newton's iterations for a stage give up.
namespace newton {

inline constexpr int kMaxIterations = 25;  ///< at the worst rate that is accepted, ten digits
inline constexpr int kFree = 3;            ///< first iterations, whose rate of convergence does not matter
inline constexpr double kSlow = 0.4;       ///< residual over the last one: a worse rate gives up

}  // namespace newton

/// What happened in the islands of a JointSolver, since it was made.
struct JointCounters {
  std::uint64_t stages = 0;
  std::uint64_t iterations = 0;   ///< of Newton, all stages together
  std::uint64_t refined = 0;      ///< steps repeated with shorter stages because one had not converged
  std::uint64_t halved = 0;       ///< stages done in two halves, where that did not help
  std::uint64_t regularised = 0;  ///< the fall-back: bounded, not exact
  std::uint64_t dependent = 0;    ///< rows that others imply, each time a matrix was factored
  std::uint64_t unsettled = 0;    ///< active sets that did not settle
  std::uint64_t quarantined = 0;  ///< islands frozen because their numbers are out of range
  std::uint64_t broken = 0;       ///< joints
};

}  // namespace naiad::physics
