// When Newton's iterations for a step of joints give up.
#pragma once

namespace naiad::physics::newton {

inline constexpr int kMaxIterations = 25;  ///< at the worst rate that is accepted, ten digits
inline constexpr int kFree = 3;            ///< first iterations, whose rate of convergence does not matter
inline constexpr double kSlow = 0.4;       ///< residual over the last one: a worse rate gives up

}  // namespace naiad::physics::newton
