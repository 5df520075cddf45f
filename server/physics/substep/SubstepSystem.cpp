#include "physics/substep/SubstepSystem.h"

#include <algorithm>
#include <tuple>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr double kRegularisation = 1e-9;  // of the diagonal, for joints that repeat each other

// Returns an order without fill if the bodies form trees, from their ends inwards; otherwise an empty list.
// Faster than eliminationOrder().
std::vector<int> treeOrder(std::span<const JointRow> rows, std::span<const JointMass> masses) {
  const auto moves = [&](int body) {
    return body >= 0 && (masses[at(body)].inverse_mass > 0 || masses[at(body)].inverse_inertia > 0);
  };
  struct Side {
    int body, other, row;
    bool operator<(const Side& s) const {
      return std::tie(body, other, row) < std::tie(s.body, s.other, s.row);
    }
  };
  std::vector<int> order;
  std::vector<Side> sides;  // each row between two movable bodies, twice
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int a = rows[i].a, b = rows[i].b, number = static_cast<int>(i);
    if (moves(a) && moves(b)) {
      sides.push_back({a, b, number});
      sides.push_back({b, a, number});
    } else {
      order.push_back(number);
    }
  }
  std::sort(sides.begin(), sides.end());
  std::vector<std::size_t> begin(masses.size() + 1, 0);
  std::vector<int> degree(masses.size(), 0);  // number of bodies to which each is still joined
  for (std::size_t i = 0; i < sides.size(); ++i) {
    ++begin[at(sides[i].body) + 1];
    const bool is_new = i == 0 || sides[i].body != sides[i - 1].body || sides[i].other != sides[i - 1].other;
    if (is_new) ++degree[at(sides[i].body)];
  }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  for (std::size_t start = 0; start < masses.size(); ++start) {
    for (std::size_t leaf = start; degree[leaf] == 1;) {
      degree[leaf] = 0;
      std::size_t next = leaf;
      for (std::size_t i = begin[leaf]; i < begin[leaf + 1]; ++i) {
        if (degree[at(sides[i].other)] == 0) continue;
        next = at(sides[i].other);
        order.push_back(sides[i].row);
      }
      leaf = next;
      --degree[leaf];
    }
  }
  if (order.size() < rows.size()) order.clear();
  return order;
}

}  // namespace

bool SubstepSystem::isBuiltFor(std::span<const int> key) const {
  return std::equal(m_key.begin(), m_key.end(), key.begin(), key.end());
}

void SubstepSystem::build(std::span<const int> key, std::span<const JointRow> rows,
                          std::span<const JointMass> masses) {
  m_key.assign(key.begin(), key.end());
  std::vector<int> order = treeOrder(rows, masses);
  if (order.empty()) order = eliminationOrder(rows, masses);
  m_places.assign(rows.size(), 0);
  m_along.clear();
  for (const int number : order) {
    m_places[at(number)] = static_cast<std::int32_t>(m_along.size());
    m_along.push_back(rows[at(number)]);
  }
  m_matrix.analyse(m_along, masses);
  m_rows.assign(rows.size(), {});
  m_is_out.assign(rows.size(), 0);
  m_softness.assign(rows.size(), 0);
  m_change.assign(rows.size(), 0);
}

void SubstepSystem::begin(std::span<const std::int32_t> states, std::span<const JointMass> masses) {
  m_states.assign(states.begin(), states.end());
  m_masses.assign(masses.begin(), masses.end());
  m_velocities.resize(states.size());
  m_has_springs = std::any_of(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.softness > 0; });
  m_is_factored = false;
}

void SubstepSystem::place(int number, Vec2 n, double ja, double jb) {
  JointRow& along = m_along[at(m_places[at(number)])];
  along.n = n;
  along.ja = ja, along.jb = jb;
  m_is_factored = false;
}

void SubstepSystem::load(std::span<const SubstepState> states) {
  for (std::size_t i = 0; i < m_states.size(); ++i) {
    const SubstepState& s = states[at(m_states[i])];
    m_velocities[i] = {{s.vx, s.vy}, s.spin};
  }
}

void SubstepSystem::store(std::span<SubstepState> states) const {
  for (std::size_t i = 0; i < m_states.size(); ++i) {
    const JointMass& mass = m_masses[i];
    SubstepState& s = states[at(m_states[i])];
    const Velocity& now = m_velocities[i];
    if (mass.inverse_mass > 0)
      s.vx = static_cast<float>(now.linear.x), s.vy = static_cast<float>(now.linear.y);
    if (mass.inverse_inertia > 0) s.spin = static_cast<float>(now.spin);
  }
}

// Returns the speed along a row that is still to be removed.
double SubstepSystem::errorOf(int i, bool is_soft) const {
  const Row& row = m_rows[at(i)];
  const JointRow& along = m_along[at(i)];
  const Velocity& b = m_velocities[at(along.b)];
  double speed = row.speed - row.target + dot(along.n, b.linear) + along.jb * b.spin;
  if (along.a >= 0) {
    const Velocity& a = m_velocities[at(along.a)];
    speed += along.ja * a.spin - dot(along.n, a.linear);
  }
  if (is_soft || row.is_limit) speed += row.bias;
  if (is_soft) speed += row.softness * row.impulse;
  return speed;
}

void SubstepSystem::apply(int i, double impulse) {
  m_rows[at(i)].impulse += impulse;
  const JointRow& along = m_along[at(i)];
  Velocity& b = m_velocities[at(along.b)];
  const JointMass mass_b = m_masses[at(along.b)];
  b.linear += (mass_b.inverse_mass * impulse) * along.n;
  b.spin += mass_b.inverse_inertia * impulse * along.jb;
  if (along.a < 0) return;
  Velocity& a = m_velocities[at(along.a)];
  const JointMass mass_a = m_masses[at(along.a)];
  a.linear -= (mass_a.inverse_mass * impulse) * along.n;
  a.spin += mass_a.inverse_inertia * impulse * along.ja;
}

bool SubstepSystem::staysAtBound(int i, bool is_soft) const {
  const Row& row = m_rows[at(i)];
  if (row.impulse > row.low && row.impulse < row.high) return false;
  const double error = errorOf(i, is_soft);
  return (row.impulse <= row.low && error >= 0) || (row.impulse >= row.high && error <= 0);
}

void SubstepSystem::factor(bool is_soft) {
  const bool is_known =
      m_is_factored && m_factored_out == m_is_out && (!m_has_springs || m_was_soft == is_soft);
  if (is_known) return;
  for (std::size_t i = 0; i < m_rows.size(); ++i) m_softness[i] = is_soft ? m_rows[i].softness : 0;
  m_matrix.factor(m_along.data(), m_masses.data(), m_is_out.data(), m_softness.data(), kRegularisation);
  m_is_factored = true;
  m_was_soft = is_soft;
  m_factored_out = m_is_out;
}

bool SubstepSystem::isScaled(std::span<const float> factors) const {
  for (std::size_t i = 0; i < m_states.size(); ++i) {
    if (m_masses[i].inverse_mass + m_masses[i].inverse_inertia > 0) return factors[at(m_states[i])] != 1;
  }
  return false;
}

void SubstepSystem::beginSubstep(std::span<SubstepState> states) {
  load(states);
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    Row& row = m_rows[i];
    const double kept =
        row.impulse != 0 && (row.impulse <= row.low || row.impulse >= row.high) ? row.impulse : 0;
    row.impulse = 0;
    if (kept != 0) apply(static_cast<int>(i), std::clamp(kept, row.low, row.high));
  }
  store(states);
}

void SubstepSystem::solve(std::span<SubstepState> states, bool is_soft) {
  load(states);
  const auto size = static_cast<int>(m_rows.size());
  m_has_springs = std::any_of(m_rows.begin(), m_rows.end(), [](const Row& row) { return row.softness > 0; });
  const auto takesPart = [&](const Row& row) { return is_soft || !row.is_spring; };
  for (int i = 0; i < size; ++i)
    m_is_out[at(i)] = !takesPart(m_rows[at(i)]) || staysAtBound(i, is_soft) ? 1 : 0;
  for (int round = 1;; ++round) {
    factor(is_soft);
    for (int i = 0; i < size; ++i) m_change[at(i)] = m_is_out[at(i)] != 0 ? 0 : -errorOf(i, is_soft);
    m_matrix.solve(m_change.data());
    const bool is_last = round == kMaxRounds;
    bool is_beyond = false;
    for (int i = 0; i < size && !is_last; ++i) {
      const Row& row = m_rows[at(i)];
      const double now = row.impulse + m_change[at(i)];
      if (m_is_out[at(i)] != 0 || (now >= row.low && now <= row.high)) continue;
      apply(i, (now < row.low ? row.low : row.high) - row.impulse);
      m_is_out[at(i)] = 1;
      is_beyond = true;
    }
    if (is_beyond) continue;
    for (int i = 0; i < size; ++i) {
      const Row& row = m_rows[at(i)];
      if (m_is_out[at(i)] == 0)
        apply(i, std::clamp(row.impulse + m_change[at(i)], row.low, row.high) - row.impulse);
    }
    if (is_last) break;
    bool is_again = false;
    for (int i = 0; i < size; ++i) {
      if (m_is_out[at(i)] == 0 || !takesPart(m_rows[at(i)]) || staysAtBound(i, is_soft)) continue;
      m_is_out[at(i)] = 0;
      is_again = true;
    }
    if (!is_again) break;
  }
  store(states);
}

}  // namespace naiad::physics
