// A stage of RATTLE. If it does not converge, it is halved, at last regularised, which only overflow stops.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/joint/JointIsland.h"
#include "physics/joint/JointMethod.h"

namespace naiad::physics {

namespace {

constexpr int kMaxHalvings = 5;     // number of times that a stage may be halved, down to 1/32
constexpr double kDiverged = 1e30;  // if a residual is larger, the iteration ends before numbers overflow
constexpr double kStalled = 20;     // in tolerances: a residual below this that does not decrease is rounding
constexpr int kMaxActiveSets = 16;  // limit of passes; in their second half, rows are only released

}  // namespace

void JointIsland::move(double h) {
  m_motion.move(h);
  if (m_motion.is_turning) m_constraints.setArms(m_motion);
}

void JointIsland::applyImpulses(const std::vector<double>& impulse) {
  m_motion.applyImpulses(m_constraints.rows, impulse.data(), !m_constraints.rods.empty());
}

void JointIsland::restore() {
  m_motion.restore();
  if (m_motion.is_turning) m_constraints.setArms(m_motion);
  for (const int row : m_constraints.soft) m_constraints.value[at(row)] = m_constraints.value_before[at(row)];
  std::fill(m_constraints.multiplier.begin(), m_constraints.multiplier.end(), 0.0);
}

void JointIsland::factor(bool is_for_positions, JointCounters& counters, double regularisation) {
  const JointConstraints& its = m_constraints;
  const std::uint8_t* is_out = is_for_positions || its.is_smooth ? its.is_out.data() : m_is_out_second.data();
  const double* softness = is_for_positions && !its.soft.empty() ? its.diagonal.data() : nullptr;
  counters.dependent += static_cast<std::uint64_t>(
      m_matrix.factor(its.rows.data(), m_motion.mass.data(), is_out, softness, regularisation));
  m_is_factored = regularisation == 0 && (is_for_positions || its.is_smooth);
}

// Uses the matrix at the start of the stage, whose error is proportional to the angle turned in the stage. If
// convergence is slow, h does not resolve the motion. Newton's exact method would converge then, but the
// energy would be wrong (measured on a rope with a thousandfold weight).
bool JointIsland::iterateNewton(double h, JointCounters& counters) {
  JointConstraints& its = m_constraints;
  const int rows = static_cast<int>(its.rows.size());
  const double to_impulse = -1 / h;
  double last = kNoLimit;
  for (int iteration = 0; iteration < newton::kMaxIterations; ++iteration) {
    move(h);
    its.evaluate<false>(m_motion);
    double worst = 0;
    bool is_finite = true;
    if (its.is_smooth) {
      for (std::size_t i = 0; i < its.rows.size(); ++i) {
        const double rest = its.value[i];
        worst = std::max(worst, std::abs(rest));
        is_finite &= rest - rest == 0;
        m_rest[i] = rest * to_impulse;
      }
    } else {
      for (int row = 0; row < rows; ++row) {
        const double rest = its.is_out[at(row)] != 0 ? 0 : its.residual(row, m_motion, h);
        worst = std::max(worst, std::abs(rest));
        is_finite &= rest - rest == 0;
        m_rest[at(row)] = rest * to_impulse;
      }
    }
    if (!is_finite || worst > kDiverged) return false;
    if (worst <= m_tolerance) return true;
    if (iteration >= newton::kFree && worst > newton::kSlow * last) return worst <= kStalled * m_tolerance;
    last = worst;
    ++counters.iterations;
    m_matrix.solve(m_rest.data());
    for (std::size_t i = 0; i < its.rows.size(); ++i) its.multiplier[i] += m_rest[i];
    applyImpulses(m_rest);
  }
  return false;
}

bool JointIsland::solvePositions(double h, JointCounters& counters) {
  for (int pass = 0; pass < kMaxActiveSets; ++pass) {
    if (!m_constraints.is_smooth || !m_is_factored) factor(true, counters);
    if (pass > 0) m_motion.restoreKicked();
    applyImpulses(m_constraints.multiplier);
    if (!iterateNewton(h, counters)) return false;
    if (m_constraints.one_sided.empty()) return true;
    const bool may_clamp = pass < kMaxActiveSets / 2;
    if (!m_constraints.changeActiveSet(m_motion, h, may_clamp, m_tolerance)) return true;
  }
  ++counters.unsettled;
  return true;
}

// Projects the velocities onto those that hard rows, and one-sided rows that pulled in the first half, allow.
// Releases rows that would push in the second half.
void JointIsland::projectVelocities(JointCounters& counters) {
  constexpr int kRounds = 3;  // limit of rounds; all but the first refine, if the matrix is ill-conditioned
  constexpr double kRefined = 1e-12;  // part of the first residual; refinement ends below it
  const JointConstraints& its = m_constraints;
  if (!its.one_sided.empty()) m_motion.saveKicked();
  for (int pass = 0; pass < kMaxActiveSets; ++pass) {
    factor(false, counters);
    const std::uint8_t* is_out = its.is_smooth ? its.is_out.data() : m_is_out_second.data();
    std::fill(m_second.begin(), m_second.end(), 0.0);
    double first = 0;
    for (int round = 0; round < kRounds; ++round) {
      double worst = 0;
      for (std::size_t i = 0; i < its.rows.size(); ++i) {
        const double rest =
            is_out[i] != 0 ? 0 : its.targetSpeed(static_cast<int>(i)) - m_motion.speedAlong(its.rows[i]);
        worst = std::max(worst, std::abs(rest));
        m_rest[i] = rest;
      }
      if (round > 0 && worst <= kRefined * first) break;
      first = round == 0 ? worst : first;
      m_matrix.solve(m_rest.data());
      for (std::size_t i = 0; i < its.rows.size(); ++i) m_second[i] += m_rest[i];
      applyImpulses(m_rest);
    }
    bool has_changed = false;
    for (const int row : its.one_sided) {
      if (m_is_out_second[at(row)] != 0) continue;
      const double s = m_second[at(row)];
      if (s >= its.low[at(row)] && s <= its.high[at(row)]) continue;
      m_is_out_second[at(row)] = 1;
      has_changed = true;
    }
    if (!has_changed) break;
    m_motion.restoreKicked();
  }
}

void JointIsland::finishVelocities(double h, JointCounters& counters) {
  using Kind = JointConstraints::Kind;
  JointConstraints& its = m_constraints;
  its.addForces(its.multiplier);
  its.evaluate<true>(m_motion);
  m_motion.kick(0.5 * h);
  if (!its.is_smooth) {
    for (std::size_t i = 0; i < its.rows.size(); ++i) {
      const bool is_again = its.kind[i] == Kind::kSoft || (its.kind[i] == Kind::kMotor && its.side[i] != 0);
      m_rest[i] = is_again ? its.multiplier[i] : 0;
      m_is_out_second[i] = its.kind[i] == Kind::kSoft || its.side[i] != 0 ? 1 : 0;
    }
    applyImpulses(m_rest);
    its.addForces(m_rest);
  }
  projectVelocities(counters);
  its.addForces(m_second);
}

bool JointIsland::stage(double h, JointCounters& counters) {
  ++counters.stages;
  m_motion.save();
  m_motion.kick(0.5 * h);
  const double ratio = h / m_last_h;
  for (double& s : m_constraints.multiplier) s *= ratio;
  m_last_h = h;
  if (!m_constraints.is_smooth) {
    m_constraints.prepare(m_motion, h);
    m_motion.saveKicked();
  }
  if (!solvePositions(h, counters)) {
    restore();
    return false;
  }
  finishVelocities(h, counters);
  return true;
}

bool JointIsland::advance(double h, int depth, JointCounters& counters) {
  if (m_is_regularised) return regularisedStage(h, counters);
  if (stage(h, counters)) return true;
  if (depth == kMaxHalvings) return regularisedStage(h, counters);
  ++counters.halved;
  return advance(0.5 * h, depth + 1, counters) && advance(0.5 * h, depth + 1, counters);
}

// Moves the bodies by impulses to the nearest places that fulfil the constraints (Gauss–Newton).
bool JointIsland::projectPlaces(double h, JointCounters& counters) {
  constexpr double kRegularisation = 1e-9;  // part of the diagonal; makes dependent rows solvable
  constexpr int kRounds = 12;               // limit, rarely reached because convergence is quadratic
  constexpr double kNear = 20;              // in tolerances: sufficient for a stage that is not exact
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

// Lets the bodies fly freely, then moves them to the nearest places that fulfil the constraints (fast
// projection: Goldenthal et al. 2007). The velocity is that displacement divided by h, projected. In effect
// this is backward Euler, which damps what h does not resolve. If there is no such place, retries with slower
// light bodies, and at last stops all bodies. Finally limits the growth of the energy to the forces' work.
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
