#include "physics/joint/JointMethod.h"

#include <algorithm>

namespace naiad::physics {

namespace {

// Yoshida 1990 (three stages of order 4; seven of order 6, his solution A), Suzuki 1990, Kahan and Li 1997.
// Lengths over the step; the middle one makes the sum 1.
constexpr double kOne[] = {1.0};
constexpr double kY1 = 1.3512071919596576340;  // 1 / (2 − ∛2)
constexpr double kYoshidaFour[] = {kY1, 1 - 2 * kY1, kY1};
constexpr double kS1 = 0.41449077179437573714;  // 1 / (4 − ∛4)
constexpr double kSuzukiFour[] = {kS1, kS1, 1 - 4 * kS1, kS1, kS1};
constexpr double kA1 = 0.28, kA2 = 0.62546642846767004501;
constexpr double kKahanLiFour[] = {kA1, kA2, 1 - 2 * (kA1 + kA2), kA2, kA1};
constexpr double kB1 = 0.78451361047755726382, kB2 = 0.23557321335935813368, kB3 = -1.17767998417887100695;
constexpr double kYoshidaSix[] = {kB1, kB2, kB3, 1 - 2 * (kB1 + kB2 + kB3), kB3, kB2, kB1};
constexpr double kC1 = 0.39216144400731413928, kC2 = 0.33259913678935943860, kC3 = -0.70624617255763935981,
                 kC4 = 0.082213596293550800230;
constexpr double kKahanLiSix[] = {kC1, kC2, kC3, kC4, 1 - 2 * (kC1 + kC2 + kC3 + kC4), kC4, kC3, kC2, kC1};

}  // namespace

std::span<const double> stagesOf(JointMethod method) {
  switch (method) {
    case JointMethod::kYoshida4:
      return kYoshidaFour;
    case JointMethod::kSuzuki4:
      return kSuzukiFour;
    case JointMethod::kKahanLi4:
      return kKahanLiFour;
    case JointMethod::kYoshida6:
      return kYoshidaSix;
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
