#include "physics/joint/JointRod.h"

#include <cmath>
#include <cstddef>
#include <span>

#include "physics/joint/JointMotion.h"

namespace naiad::physics {

bool stepRod(JointBody& a, JointBody& b, Joint& joint, double h, Vec2 gravity, const JointOptions& options,
             JointCounters& counters) {
  constexpr double kStretched = 1e-6;    // limit of |(length / rest length)² − 1| for this method
  constexpr double kNearlyUnit = 1e-10;  // this near to 1, two terms of the inverse root's series are exact
  const double sum = a.inverse_mass + b.inverse_mass;
  const double per_length = 1 / joint.length;
  const Vec2 push_a = accelerationOf(a, gravity), push_b = accelerationOf(b, gravity);
  const Vec2 start = b.place - a.place, direction = start / joint.length;
  const double square = lengthSquared(direction);
  const bool is_good = sum > 0 && a.spin == 0 && b.spin == 0 && std::abs(square - 1) <= kStretched &&
                       isBelow(a.velocity, kMaxJointMotion) && isBelow(b.velocity, kMaxJointMotion) &&
                       isBelow(push_a, kMaxJointMotion) && isBelow(push_b, kMaxJointMotion);
  if (!is_good) return false;
  const double share_a = a.inverse_mass / sum, share_b = b.inverse_mass / sum;
  const double to_unit = std::abs(square - 1) <= kNearlyUnit ? 1.5 - 0.5 * square : 1 / std::sqrt(square);
  JointRod rod(to_unit * direction, per_length * (b.velocity - a.velocity), per_length * (push_b - push_a));
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = repeatsOf(options);
  const double whole = h / repeats;
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      if (!rod.advance(share * whole, 1 / (share * whole))) return false;
    }
  }
  counters.stages += stages.size() * static_cast<std::size_t>(repeats);
  const Vec2 velocity = share_b * a.velocity + share_a * b.velocity;
  const Vec2 push = share_b * push_a + share_a * push_b;
  const Vec2 flown = h * (velocity + (0.5 * h) * push), after = velocity + h * push;
  const Vec2 turned = joint.length * rod.direction - start, velocity_after = joint.length * rod.velocity();
  if (a.inverse_mass > 0) {
    a.place = a.place + (flown - share_a * turned);
    a.velocity = after - share_a * velocity_after;
  }
  if (b.inverse_mass > 0) {
    b.place = b.place + (flown + share_b * turned);
    b.velocity = after + share_b * velocity_after;
  }
  joint.force = (joint.length / (h * sum)) * rod.pull;
  return true;
}

}  // namespace naiad::physics
