// The time stepping of jointed bodies: RATTLE, alone or composed to a higher order.
//
// RATTLE (Andersen 1983) is symmetric and symplectic of order 2. A symmetric composition of sub-steps of
// suitable lengths, some of them backwards, has order 4 or 6 and keeps both properties (Suzuki 1990; Kahan
// and Li 1997; Hairer, Lubich, Wanner, "Geometric Numerical Integration", V.3). Joints that lose energy
// (damping, ropes that become taut, limits, motors) cannot run backwards, and use RATTLE alone.
#pragma once

#include <cstdint>
#include <span>

namespace naiad::physics {

enum class JointMethod : std::uint8_t {
  kAutomatic,  ///< order 4 for islands that conserve energy and turn slowly (order 6 if a stiff mouse joint
               ///< pulls), else RATTLE
  kRattle,     ///< order 2, 1 stage
  kSuzuki4,    ///< order 4, 5 stages
  kKahanLi6,   ///< order 6, 9 stages
};

struct JointOptions {
  JointMethod method = JointMethod::kAutomatic;
  int substeps = 8;  ///< stages in a step; a composition is repeated as often as fits, at least once
};

/// Returns the lengths of a method's stages; their sum is 1.
std::span<const double> stagesOf(JointMethod method);
/// Returns how often a step repeats the stages.
int repeatsOf(const JointOptions& options);

/// Limits of Newton's iteration for a stage.
namespace newton {

inline constexpr int kMaxIterations = 25;  ///< enough for ten digits at the slowest rate that kSlow accepts
inline constexpr int kFree = 3;            ///< number of first iterations whose convergence is not checked
inline constexpr double kSlow = 0.4;       ///< fails if a residual exceeds this fraction of the previous one

}  // namespace newton

/// Counters of a JointSolver over all its islands.
struct JointCounters {
  std::uint64_t stages = 0;
  std::uint64_t iterations = 0;   ///< Newton iterations of all stages
  std::uint64_t refined = 0;      ///< steps repeated with shorter stages because a stage had not converged
  std::uint64_t halved = 0;       ///< stages done in two halves, if repeating the step did not help
  std::uint64_t regularised = 0;  ///< regularised stages, the last resort: bounded, but not exact
  std::uint64_t dependent = 0;    ///< redundant rows, counted at each factorisation
  std::uint64_t unsettled = 0;    ///< active sets that kept changing up to the limit of iterations
  std::uint64_t quarantined = 0;  ///< islands frozen because their numbers are out of range
  std::uint64_t broken = 0;       ///< joints that broke
};

}  // namespace naiad::physics
