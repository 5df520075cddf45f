// All jointed bodies of a scene: finds their islands, and steps each of them.
//
// The caller owns the arrays; the solver has the islands and its working memory. A step does not allocate,
// unless a joint broke before. Islands are independent: nothing that happens in one, including quarantine,
// changes the bits of another. Not thread-safe.
#pragma once

#include <span>
#include <vector>

#include "physics/joint/JointIsland.h"

namespace naiad::physics {

class JointSolver {
 public:
  /// Finds the islands. Call when bodies or joints were added, removed or changed in any number except place,
  /// velocity, rotation, spin, force, torque, target, speed, stiffness, damping, limits or strength.
  /// Unfreezes frozen islands. Returns 0, or −1 without any change if a joint or body is invalid.
  int connect(std::span<const JointBody> bodies, std::span<const Joint> joints);

  /// Moves every joined body over h > 0, including immovable ones that have a velocity, and writes forces
  /// into the joints; all other bodies are unchanged. Gravity is an acceleration of all bodies with mass.
  /// Skips islands whose entry of `is_moved` (by island; may be empty) is set, because they have been stepped
  /// already. Returns 0, or −1 without any effect if h, gravity, `substeps` or an array's size is invalid.
  int step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
           JointOptions options = {}, std::span<const std::uint8_t> is_moved = {});

  /// Steps one island alone, by a part of a step.
  void stepIsland(int island, std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity) {
    m_islands[static_cast<std::size_t>(island)].step(bodies, joints, h, gravity, {}, m_counters);
  }
  /// Projects the velocities of one island onto those that its joints allow.
  void holdIsland(int island, std::span<JointBody> bodies, std::span<const Joint> joints) {
    m_islands[static_cast<std::size_t>(island)].hold(bodies, joints, m_counters);
  }
  /// Returns the index in islands() of a movable body's island; −1 if the body is not joined.
  int islandOf(int body) const { return m_island_of[static_cast<std::size_t>(body)]; }

  const JointCounters& counters() const { return m_counters; }
  std::span<const JointIsland> islands() const { return m_islands; }
  /// True if the body belongs to an island; an immovable one can belong to several.
  bool isJoined(int body) const { return m_is_joined[static_cast<std::size_t>(body)] != 0; }

 private:
  bool breakJoints(std::span<Joint> joints);

  std::vector<JointIsland> m_islands;
  std::vector<std::uint8_t> m_is_joined;
  std::vector<int> m_island_of;  // by body; −1: not joined, or immovable and in several islands
  std::vector<int> m_carriers;   // indices of immovable bodies
  std::size_t m_joint_count = 0;
  JointCounters m_counters;
};

}  // namespace naiad::physics
