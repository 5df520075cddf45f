// The forces of contacts and attachments within one group of soft bodies, all at once.
//
// Each row has the compliance of all bodies of the group, as a whole and implicitly: a column of the inverse
// of the bodies' own systems. So a stiff beam on two supports is as easy as a ball. What is left is a
// complementarity problem with friction, as large as the number of contacts, swept by Gauss and Seidel, there
// and back.
#pragma once

#include <span>
#include <vector>

#include "physics/soft/SoftContact.h"
#include "physics/soft/SoftElastic.h"

namespace naiad::physics {

/// An obstacle's motion within a sub-step.
struct SoftObstacleMotion {
  Vec2 velocity;  ///< at its end, without contacts
  double spin = 0;
  double inverse_mass = 0;
  double inverse_inertia = 0;
};

class SoftRowSolver {
 public:
  /// What a group's solution needs to see; by body id and by obstacle's index.
  struct Scene {
    const std::vector<SoftBody>& bodies;
    const std::vector<SoftElastic>& elastics;
    const std::vector<SoftObstacleMotion>& obstacle_motions;
    double h;
  };

  /// Finds the rows' forces. Each starts from what it has. False if the sweeps did not settle.
  bool solve(const Scene& scene, const std::vector<int>& group, std::vector<SoftRow*>& rows);
  /// The change of a body of the group, by rows of its system, contacts included.
  std::span<const double> changeOf(int body) const {
    return {&m_changes[m_begins[static_cast<std::size_t>(body)]], m_sizes[static_cast<std::size_t>(body)]};
  }

 private:
  void gather(const Scene& scene, const std::vector<int>& group);
  void respond(const Scene& scene, SoftRow& row);
  void push(const Scene& scene, const SoftRow& row, int axis, double force);
  double moved(const Scene& scene, const SoftRow& row, int axis) const;
  double fixedGap(const Scene& scene, const SoftRow& row, int axis) const;
  double compliance(const Scene& scene, const SoftRow& row, int axis) const;
  double settle(const Scene& scene, std::size_t index, SoftRow& row);

  std::vector<double> m_responses;    // to a force of one along each axis of each row
  std::vector<double> m_changes;      // of the bodies' offsets
  std::vector<std::size_t> m_begins;  // by body: where its part of them begins
  std::vector<std::size_t> m_sizes;
  std::vector<SoftObstacleMotion> m_motions;  // obstacles' motion
  std::vector<double> m_gaps;                 // two per row: that which does not change
  std::vector<double> m_compliances;          // two per row: displacement by a force of one
};

}  // namespace naiad::physics
