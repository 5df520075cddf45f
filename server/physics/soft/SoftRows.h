// Solves the forces of all contacts and attachments within a group of soft bodies.
//
// Each row has the implicit compliance of all bodies of the group: a column of the inverse of the bodies' own
// systems. So a stiff beam on two supports is as easy as a ball. What remains is a complementarity problem
// with friction, of the size of the number of contacts, solved by Gauss–Seidel sweeps in both directions.
#pragma once

#include <span>
#include <vector>

#include "physics/soft/SoftContact.h"
#include "physics/soft/SoftElastic.h"

namespace naiad::physics {

/// An obstacle's motion within a sub-step.
struct SoftObstacleMotion {
  Vec2 velocity;  ///< velocity at the end of the sub-step, without contacts
  double spin = 0;
  double inverse_mass = 0;
  double inverse_inertia = 0;
};

class SoftRowSolver {
 public:
  /// The input for the solution of a group, indexed by body id and by obstacle index.
  struct Scene {
    const std::vector<SoftBody>& bodies;
    const std::vector<SoftElastic>& elastics;
    const std::vector<SoftObstacleMotion>& obstacle_motions;
    double h;
  };

  /// Finds the rows' forces, starting from their present ones. Returns false if the sweeps did not converge.
  bool solve(const Scene& scene, const std::vector<int>& group, std::vector<SoftRow*>& rows);
  /// Returns the change of a body's offsets, including that by contacts, by rows of the body's own system.
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

  std::vector<double> m_responses;    // responses to a unit force along each axis of each row
  std::vector<double> m_changes;      // changes of the bodies' offsets
  std::vector<std::size_t> m_begins;  // by body: start of its part of m_changes
  std::vector<std::size_t> m_sizes;
  std::vector<SoftObstacleMotion> m_motions;  // motions by index of the obstacle
  std::vector<double> m_gaps;                 // two per row: the constant part of the gaps
  std::vector<double> m_compliances;          // two per row: displacement by a unit force
};

}  // namespace naiad::physics
