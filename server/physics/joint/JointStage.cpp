// A stage of RATTLE, and what happens where it does not converge.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/joint/JointIsland.h"

namespace naiad::physics {

namespace {

constexpr int kMaxIterations = 25;
constexpr int kMaxHalvings = 5;
constexpr int kFree = 3;       // iterations whose rate does not matter
constexpr double kSlow = 0.4;  // a worse rate gives up
constexpr int kMaxActiveSets = 16;

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

void JointIsland::save() {
  m_place_before = m_place;
  m_velocity_before = m_velocity;
  if (m_is_turning) {
    m_rotation_before = m_rotation;
    m_spin_before = m_spin;
  }
}

void JointIsland::restore() {
  m_place = m_place_before;
  m_velocity = m_velocity_before;
  if (m_is_turning) {
    m_rotation = m_rotation_before;
    m_spin = m_spin_before;
    setArms();
  }
  for (const int row : m_soft) m_value[at(row)] = m_value_before[at(row)];
  std::fill(m_multiplier.begin(), m_multiplier.end(), 0.0);
}

void JointIsland::kick(double h) {
  for (std::size_t i = 0; i < m_velocity.size(); ++i) m_velocity[i] += h * m_acceleration[i];
  if (!m_is_turning) return;
  for (std::size_t i = 0; i < m_spin.size(); ++i) m_spin[i] += h * m_turn_acceleration[i];
}

void JointIsland::move(double h) {
  for (std::size_t i = 0; i < m_place.size(); ++i) m_place[i] = m_place_before[i] + h * m_velocity[i];
  if (!m_is_turning) return;
  for (std::size_t i = 0; i < m_spin.size(); ++i) {
    if (m_spin[i] != 0) m_rotation[i] = turned(m_rotation_before[i], h * m_spin[i]);
  }
  setArms();
}

void JointIsland::apply(const double* impulse) {
  if (!m_is_turning && !m_rods.empty()) {
    for (const JointRow& row : m_rows) {
      const Vec2 push = *impulse++ * row.n;
      m_velocity[at(row.b)] += m_mass[at(row.b)].inverse_mass * push;
      m_velocity[at(row.a)] -= m_mass[at(row.a)].inverse_mass * push;
    }
    return;
  }
  for (const JointRow& row : m_rows) {
    const double s = *impulse++;
    const JointMass& b = m_mass[at(row.b)];
    m_velocity[at(row.b)] += (b.inverse_mass * s) * row.n;
    if (m_is_turning) m_spin[at(row.b)] += b.inverse_inertia * s * row.jb;
    if (row.a < 0) continue;
    const JointMass& a = m_mass[at(row.a)];
    m_velocity[at(row.a)] -= (a.inverse_mass * s) * row.n;
    if (m_is_turning) m_spin[at(row.a)] += a.inverse_inertia * s * row.ja;
  }
}

void JointIsland::record(const std::vector<double>& impulse) {
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const JointRow& row = m_rows[i];
    const std::size_t link = at(m_link_of[i]);
    m_force[link] += impulse[i] * row.n;
    if (row.n == Vec2{}) m_torque[link] += impulse[i] * row.jb;
  }
}

void JointIsland::factor(bool is_for_positions, JointCounters& counters, double regularisation) {
  const std::uint8_t* is_out = is_for_positions || m_is_smooth ? m_is_out.data() : m_is_out_second.data();
  const double* softness = is_for_positions && !m_soft.empty() ? m_diagonal.data() : nullptr;
  counters.dependent += static_cast<std::uint64_t>(
      m_matrix.factor(m_rows.data(), m_mass.data(), is_out, softness, regularisation));
  m_is_factored = regularisation == 0 && (is_for_positions || m_is_smooth);
}

// Simplified: the matrix of the start, whose error is of the order of the angle turned in a stage. That it
// converges slowly says that h does not resolve the motion, and Newton's exact method, which would converge
// there, buys its places with energy (measured on a rope with a thousandfold weight).
bool JointIsland::newton(double h, JointCounters& counters) {
  const int rows = static_cast<int>(m_rows.size());
  const double to_impulse = -1 / h;
  double last = kNoLimit;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    move(h);
    evaluate<false>();
    double worst = 0;
    bool is_finite = true;
    if (m_is_smooth) {
      for (std::size_t i = 0; i < m_rows.size(); ++i) {
        const double rest = m_value[i];
        worst = std::max(worst, std::abs(rest));
        is_finite &= rest - rest == 0;
        m_rest[i] = rest * to_impulse;
      }
    } else {
      for (int row = 0; row < rows; ++row) {
        const double rest = m_is_out[at(row)] != 0 ? 0 : residual(row, h);
        worst = std::max(worst, std::abs(rest));
        is_finite &= rest - rest == 0;
        m_rest[at(row)] = rest * to_impulse;
      }
    }
    if (!is_finite || worst > 1e30) return false;
    if (worst <= m_tolerance) return true;
    if (iteration >= kFree && worst > kSlow * last) return worst <= 20 * m_tolerance;
    last = worst;
    ++counters.iterations;
    m_matrix.solve(m_rest.data());
    for (std::size_t i = 0; i < m_rows.size(); ++i) m_multiplier[i] += m_rest[i];
    apply(m_rest.data());
  }
  return false;
}

// Does a multiplier leave its bounds, or a held one want to come back? Then the sets have changed.
bool JointIsland::changeActiveSet(double h, bool may_clamp) {
  bool has_changed = false;
  for (const int row : m_one_sided) {
    const double s = m_multiplier[at(row)];
    std::int8_t& side = m_side[at(row)];
    const std::int8_t before = side;
    if (side == 0) {
      if (may_clamp && s < m_low[at(row)]) side = -1;
      if (may_clamp && s > m_high[at(row)]) side = 1;
    } else if (side < 0 ? residual(row, h) < -m_tolerance : residual(row, h) > m_tolerance) {
      side = 0;
    }
    if (side == before) continue;
    has_changed = true;
    m_is_out[at(row)] = side != 0 ? 1 : 0;
    m_multiplier[at(row)] = side == 0 ? 0 : side < 0 ? m_low[at(row)] : m_high[at(row)];
  }
  return has_changed;
}

bool JointIsland::positions(double h, JointCounters& counters) {
  for (int pass = 0; pass < kMaxActiveSets; ++pass) {
    if (!m_is_smooth || !m_is_factored) factor(true, counters);
    if (pass > 0) {
      m_velocity = m_kicked;
      m_spin = m_spin_kicked;
    }
    apply(m_multiplier.data());
    if (!newton(h, counters)) return false;
    if (m_one_sided.empty() || !changeActiveSet(h, pass < kMaxActiveSets / 2)) return true;
  }
  ++counters.unsettled;
  return true;
}

// The rows that hold velocities: hard ones, and one-sided ones that have pulled in the first half. Those that
// would push in the second half are let go.
void JointIsland::projectVelocities(JointCounters& counters) {
  if (!m_one_sided.empty()) {
    m_kicked = m_velocity;
    m_spin_kicked = m_spin;
  }
  for (int pass = 0; pass < kMaxActiveSets; ++pass) {
    factor(false, counters);
    const std::uint8_t* is_out = m_is_smooth ? m_is_out.data() : m_is_out_second.data();
    std::fill(m_second.begin(), m_second.end(), 0.0);
    double first = 0;
    for (int round = 0; round < 3; ++round) {  // more than once only if the matrix is bad
      double worst = 0;
      for (std::size_t i = 0; i < m_rows.size(); ++i) {
        const double rest = is_out[i] != 0 ? 0 : targetSpeed(static_cast<int>(i)) - speedAlong(m_rows[i]);
        worst = std::max(worst, std::abs(rest));
        m_rest[i] = rest;
      }
      if (round > 0 && worst <= 1e-12 * first) break;
      first = round == 0 ? worst : first;
      m_matrix.solve(m_rest.data());
      for (std::size_t i = 0; i < m_rows.size(); ++i) m_second[i] += m_rest[i];
      apply(m_rest.data());
    }
    bool has_changed = false;
    for (const int row : m_one_sided) {
      if (m_is_out_second[at(row)] != 0) continue;
      const double s = m_second[at(row)];
      if (s >= m_low[at(row)] && s <= m_high[at(row)]) continue;
      m_is_out_second[at(row)] = 1;
      has_changed = true;
    }
    if (!has_changed) break;
    m_velocity = m_kicked;
    m_spin = m_spin_kicked;
  }
}

void JointIsland::velocities(double h, JointCounters& counters) {
  record(m_multiplier);
  evaluate<true>();
  kick(0.5 * h);
  if (!m_is_smooth) {
    for (std::size_t i = 0; i < m_rows.size(); ++i) {
      const bool is_again = m_kind[i] == Kind::kSoft || (m_kind[i] == Kind::kMotor && m_side[i] != 0);
      m_rest[i] = is_again ? m_multiplier[i] : 0;
      m_is_out_second[i] = m_kind[i] == Kind::kSoft || m_side[i] != 0 ? 1 : 0;
    }
    apply(m_rest.data());
    record(m_rest);
  }
  projectVelocities(counters);
  record(m_second);
}

bool JointIsland::stage(double h, JointCounters& counters) {
  ++counters.stages;
  save();
  kick(0.5 * h);
  const double ratio = h / m_last_h;
  for (double& s : m_multiplier) s *= ratio;
  m_last_h = h;
  if (!m_is_smooth) {
    prepareRows(h);
    m_kicked = m_velocity;
    m_spin_kicked = m_spin;
  }
  if (!positions(h, counters)) {
    restore();
    return false;
  }
  velocities(h, counters);
  return true;
}

bool JointIsland::advance(double h, int depth, JointCounters& counters) {
  if (m_is_beyond) return regularisedStage(h, counters);
  if (stage(h, counters)) return true;
  if (depth == kMaxHalvings) return regularisedStage(h, counters);
  ++counters.halved;
  return advance(0.5 * h, depth + 1, counters) && advance(0.5 * h, depth + 1, counters);
}

double JointIsland::kineticEnergy() const {
  double sum = 0;
  for (std::size_t i = 0; i < m_mass.size(); ++i) {
    if (m_mass[i].inverse_mass > 0) sum += 0.5 * lengthSquared(m_velocity[i]) / m_mass[i].inverse_mass;
    if (m_mass[i].inverse_inertia > 0) sum += 0.5 * m_spin[i] * m_spin[i] / m_mass[i].inverse_inertia;
  }
  return sum;
}

double JointIsland::workSince(const std::vector<Vec2>& places) const {
  double work = 0;
  for (std::size_t i = 0; i < m_mass.size(); ++i) {
    if (m_mass[i].inverse_mass > 0)
      work += dot(m_acceleration[i], m_place[i] - places[i]) / m_mass[i].inverse_mass;
  }
  return work;
}

// Gauss–Newton from where the bodies are to the nearest place that fulfils the constraints, as impulses.
bool JointIsland::projectPlaces(double h, JointCounters& counters) {
  constexpr double kRegularisation = 1e-9;
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    evaluate<true>();
    const std::uint8_t* is_out = m_is_smooth ? m_is_out.data() : m_is_out_second.data();
    double worst = 0;
    for (std::size_t i = 0; i < m_rows.size(); ++i) {
      const double rest = is_out[i] != 0 ? 0 : m_value[i];
      worst = std::max(worst, std::abs(rest));
      m_rest[i] = -rest / h;
    }
    if (worst <= 20 * m_tolerance) return true;
    if (!(worst <= 1e15)) return false;
    factor(false, counters, kRegularisation);
    m_matrix.solve(m_rest.data());
    apply(m_rest.data());
    move(h);
  }
  return false;
}

// Nobody is faster than the heaviest: what is left of a light chain's whirling on a great weight.
void JointIsland::slowLightOnes() {
  double least = kNoLimit, most = 0;
  for (std::size_t i = 0; i < m_mass.size(); ++i) {
    if (!(m_mass[i].inverse_mass > 0) || m_mass[i].inverse_mass >= least) continue;
    least = m_mass[i].inverse_mass;
    most = length(m_velocity[i]);
  }
  for (std::size_t i = 0; i < m_mass.size(); ++i) {
    const double speed = length(m_velocity[i]);
    if (m_mass[i].inverse_mass > 0 && speed > most) m_velocity[i] *= most / speed;
    if (m_mass[i].inverse_inertia > 0) m_spin[i] = 0;
  }
}

// Free flight, then the nearest place that fulfils the constraints (fast projection: Goldenthal et al. 2007);
// the velocity is what that way takes, projected. Backward Euler in effect: it damps what h does not resolve.
// If even that finds no place, the light bodies are slowed, and at last all stay where they are. A last bound
// keeps the energy from growing by more than the forces' work.
bool JointIsland::regularisedStage(double h, JointCounters& counters) {
  ++counters.regularised;
  m_is_beyond = true;
  save();
  const double energy = kineticEnergy();
  kick(h);
  if (!m_is_smooth) m_is_out_second = m_is_out;
  for (const int row : m_soft) m_is_out_second[at(row)] = 1;
  for (const int row : m_one_sided) {
    if (m_kind[at(row)] == Kind::kMotor) m_is_out_second[at(row)] = 1;
  }
  move(h);
  bool is_found = projectPlaces(h, counters);
  if (!is_found) {
    m_velocity = m_velocity_before;
    if (m_is_turning) m_spin = m_spin_before;
    kick(h);
    slowLightOnes();
    move(h);
    is_found = projectPlaces(h, counters);
  }
  if (!is_found) {
    restore();
    for (std::size_t i = 0; i < m_mass.size(); ++i) {
      if (m_mass[i].inverse_mass > 0) m_velocity[i] = {};
      if (m_mass[i].inverse_inertia > 0) m_spin[i] = 0;
    }
  }
  evaluate<true>();
  projectVelocities(counters);
  const double after = kineticEnergy(), most = std::max(0.0, energy + workSince(m_place_before));
  if (after > most) {
    const double scale = std::sqrt(most / after);
    for (std::size_t i = 0; i < m_mass.size(); ++i) {
      if (m_mass[i].inverse_mass > 0) m_velocity[i] *= scale;
      if (m_mass[i].inverse_inertia > 0) m_spin[i] *= scale;
    }
  }
  std::fill(m_multiplier.begin(), m_multiplier.end(), 0.0);
  m_is_factored = false;
  return after - after == 0;
}

}  // namespace naiad::physics
