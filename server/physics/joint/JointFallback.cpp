// The stage of a JointIsland that always ends: where Newton's method does not converge even in short ones.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/joint/JointIsland.h"

namespace naiad::physics {

// Gauss–Newton from where the bodies are to the nearest place that fulfils the constraints, as impulses.
bool JointIsland::projectPlaces(double h, JointCounters& counters) {
  constexpr double kRegularisation = 1e-9;  // of the diagonal: keeps dependent rows apart
  constexpr int kRounds = 12;   // of Gauss–Newton; quadratic near the solution, so a bound alone
  constexpr double kNear = 20;  // tolerances: near enough for a stage that is not exact
  const JointConstraints& its = m_constraints;
  for (int round = 0; round < kRounds; ++round) {
    m_constraints.evaluate<true>(m_motion);
    const std::uint8_t* is_out = its.is_smooth ? its.is_out.data() : m_is_out_second.data();
    double worst = 0;
    for (std::size_t i = 0; i < its.rows.size(); ++i) {
      const double rest = is_out[i] != 0 ? 0 : its.value[i];
      worst = std::max(worst, std::abs(rest));
      m_rest[i] = -rest / h;
    }
    if (worst <= kNear * m_tolerance) return true;
    if (!(worst <= kMaxJointMotion)) return false;
    factor(false, counters, kRegularisation);
    m_matrix.solve(m_rest.data());
    applyImpulses(m_rest);
    move(h);
  }
  return false;
}

// Free flight, then the nearest place that fulfils the constraints (fast projection: Goldenthal et al. 2007);
// the velocity is that displacement over h, projected. Backward Euler in effect: it damps what h does not
// resolve. If even that finds no place, the light bodies are slowed, and at last all stay where they are. A
// last bound keeps the energy from growing by more than the forces' work.
bool JointIsland::regularisedStage(double h, JointCounters& counters) {
  const JointConstraints& its = m_constraints;
  ++counters.regularised;
  m_is_regularised = true;
  m_motion.save();
  const double energy = m_motion.kineticEnergy();
  m_motion.kick(h);
  if (!its.is_smooth) m_is_out_second = its.is_out;
  for (const int row : its.soft) m_is_out_second[at(row)] = 1;
  for (const int row : its.one_sided) {
    if (its.kind[at(row)] == JointConstraints::Kind::kMotor) m_is_out_second[at(row)] = 1;
  }
  move(h);
  bool is_found = projectPlaces(h, counters);
  if (!is_found) {
    m_motion.restoreVelocities();
    m_motion.kick(h);
    m_motion.slowLightBodies();
    move(h);
    is_found = projectPlaces(h, counters);
  }
  if (!is_found) {
    restore();
    m_motion.stopAll();
  }
  m_constraints.evaluate<true>(m_motion);
  projectVelocities(counters);
  const double after = m_motion.kineticEnergy();
  const double most = std::max(0.0, energy + m_motion.workSinceSave());
  if (after > most) m_motion.scaleVelocities(std::sqrt(most / after));
  std::fill(m_constraints.multiplier.begin(), m_constraints.multiplier.end(), 0.0);
  m_is_factored = false;
  return after - after == 0;
}

}  // namespace naiad::physics
