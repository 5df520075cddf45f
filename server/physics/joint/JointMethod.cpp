#include "physics/joint/JointMethod.h"

#include <algorithm>

namespace naiad::physics {

namespace {

// Lengths of stages as parts of the step (Suzuki 1990, Kahan and Li 1997); the middle one makes the sum 1.
constexpr double kOne[] = {1.0};
constexpr double kS1 = 0.41449077179437573714;  // 1 / (4 − ∛4)
constexpr double kSuzukiFour[] = {kS1, kS1, 1 - 4 * kS1, kS1, kS1};
constexpr double kC1 = 0.39216144400731413928, kC2 = 0.33259913678935943860, kC3 = -0.70624617255763935981,
                 kC4 = 0.082213596293550800230;
constexpr double kKahanLiSix[] = {kC1, kC2, kC3, kC4, 1 - 2 * (kC1 + kC2 + kC3 + kC4), kC4, kC3, kC2, kC1};

}  // namespace

std::span<const double> stagesOf(JointMethod method) {
  switch (method) {
    case JointMethod::kSuzuki4:
      return kSuzukiFour;
    case JointMethod::kKahanLi6:
      return kKahanLiSix;
    default:
      return kOne;
  }
}

int repeatsOf(const JointOptions& options) {
  return std::max(1, options.substeps / static_cast<int>(stagesOf(options.method).size()));
}

}  // namespace naiad::physics
