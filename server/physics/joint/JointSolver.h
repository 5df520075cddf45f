// All jointed bodies of a scene: finds their islands, and steps each of them.
//
// The arrays belong to the caller; the solver keeps the islands and its working memory. A step allocates
// nothing, except for the one after a joint broke. Islands are independent: what happens in one, a quarantine
// too, leaves the bits of the others alone. Any thread, one at a time.
#pragma once

#include <span>
#include <vector>

#include "physics/joint/JointIsland.h"

namespace naiad::physics {

class JointSolver {
 public:
  /// Finds the islands. To be called when bodies or joints came, went, or changed in anything but place,
  /// velocity, rotation, spin, force, torque, target, speed, stiffness, damping, limits and strength. Frozen
  /// islands get another chance. Returns −1 and changes nothing if a joint or a body is not valid, else 0.
  int connect(std::span<const JointBody> bodies, std::span<const Joint> joints);

  /// Moves every body that is joined over h > 0, also immovable ones that have a velocity, and writes forces
  /// into the joints; others are left alone. Gravity is an acceleration for all bodies with mass. Returns −1
  /// and does nothing if h, gravity or the arrays' sizes are not usable, else 0.
  /// Islands with `is_moved` (by island; empty: none) have been stepped already and are skipped.
  int step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
           JointOptions options = {}, std::span<const std::uint8_t> is_moved = {});

  /// One of islands(), alone: what it does within a step.
  void stepIsland(int island, std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity) {
    m_islands[static_cast<std::size_t>(island)].step(bodies, joints, h, gravity, {}, m_counters);
  }
  /// Projects its velocities onto those that its joints allow.
  void holdIsland(int island, std::span<JointBody> bodies, std::span<const Joint> joints) {
    m_islands[static_cast<std::size_t>(island)].hold(bodies, joints, m_counters);
  }
  /// In islands(), of a body that can be moved; −1: it is not joined.
  int islandOf(int body) const { return m_island_of[static_cast<std::size_t>(body)]; }

  const JointCounters& counters() const { return m_counters; }
  std::span<const JointIsland> islands() const { return m_islands; }
  /// Is this body moved by a step?
  bool isJoined(int body) const { return m_is_joined[static_cast<std::size_t>(body)] != 0; }

 private:
  bool breakJoints(std::span<Joint> joints);

  std::vector<JointIsland> m_islands;
  std::vector<std::uint8_t> m_is_joined;
  std::vector<int> m_island_of;  // by body; −1: none, or many
  std::vector<int> m_carriers;   // immovable ones
  std::size_t m_joint_count = 0;
  JointCounters m_counters;
};

}  // namespace naiad::physics
