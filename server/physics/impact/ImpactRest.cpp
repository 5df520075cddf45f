#include "physics/impact/ImpactRest.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

namespace {

constexpr double kUnbounded = 1e300;   // larger than any push
constexpr double kRegular = 1e-12;     // part added to the diagonal; makes solutions of redundant rows unique
constexpr int kFrictionRounds = 200;   // limit; pressures and cones alternate, slowly if a body is wedged
constexpr int kSweeps = 400;           // maximum Gauss–Seidel sweeps if the direct solution fails
constexpr int kRefinements = 10;       // limit; each refinement removes most of kRegular's error
constexpr double kRowPrice = 16;       // multiplications each time that a row is used
constexpr int kMaxStored = 4'000'000;  // entries of the factor, 32 MB; larger groups are solved by sweeps

}  // namespace

double RestSolver::couple(const RestRow& a, const RestRow& b) const {
  double sum = 0;
  const auto add = [&](int body, double sign) {
    if (body >= 0) sum += sign * m_inverse_masses[body] * dot(a.direction, b.direction);
  };
  if (a.first == b.first) add(a.first, 1);
  if (a.second == b.second) add(a.second, 1);
  if (a.first == b.second) add(a.first, -1);
  if (a.second == b.first) add(a.second, -1);
  return sum;
}

double RestSolver::rateOf(const RestRow& row) const {
  double rate = row.bias;
  if (row.second >= 0) rate += dot(row.direction, m_change[row.second]);
  if (row.first >= 0) rate -= dot(row.direction, m_change[row.first]);
  return rate;
}

void RestSolver::updateChange() {
  std::fill(m_change.begin(), m_change.end(), Vec2{});
  std::fill(m_effort.begin(), m_effort.end(), 0.0);
  for (const RestRow& row : m_rows) {
    if (row.push == 0) continue;
    if (row.first >= 0) {
      m_change[row.first] -= (row.push * m_inverse_masses[row.first]) * row.direction;
      m_effort[row.first] += std::fabs(row.push) * m_inverse_masses[row.first];
    }
    if (row.second >= 0) {
      m_change[row.second] += (row.push * m_inverse_masses[row.second]) * row.direction;
      m_effort[row.second] += std::fabs(row.push) * m_inverse_masses[row.second];
    }
  }
}

// Adds `work` to the total. Returns false if the total exceeds the budget.
bool RestSolver::spend(double work) {
  if (m_work + work > m_most_work) m_is_too_costly = true;
  if (!m_is_too_costly) m_work += work;
  return !m_is_too_costly;
}

// Computes the LDLᵀ factors of the couplings between free rows, within their skyline.
bool RestSolver::factorise() {
  const int count = static_cast<int>(m_free.size());
  m_skyline.resize(count);
  m_start.resize(count);
  int stored = 0;
  double price = 0;
  for (int k = 0; k < count; ++k) {
    const RestRow& row = m_rows[m_free[k]];
    int first = k;
    for (const int body : {row.first, row.second}) {
      if (body < 0) continue;
      for (int i = m_rows_begin[body]; i < m_rows_begin[body + 1]; ++i) {
        const int other = m_index[m_rows_of[i]];
        if (other < 0) continue;
        first = std::min(first, other);
        break;
      }
    }
    m_skyline[k] = first;
    m_start[k] = stored - first;
    stored += k - first + 1;
    if (stored > kMaxStored) return false;
    price += 0.5 * static_cast<double>(k - first) * (k - first);
  }
  if (!spend(price)) return false;
  m_factor.assign(stored, 0.0);
  for (int k = 0; k < count; ++k) {
    const RestRow& row = m_rows[m_free[k]];
    double* const line = m_factor.data() + m_start[k];
    for (const int body : {row.first, row.second}) {
      if (body < 0) continue;
      for (int i = m_rows_begin[body]; i < m_rows_begin[body + 1]; ++i) {
        const int other = m_index[m_rows_of[i]];
        if (other >= 0 && other <= k) line[other] = couple(row, m_rows[m_rows_of[i]]);
      }
    }
    line[k] *= 1 + kRegular;
    double left = line[k];
    for (int j = m_skyline[k]; j < k; ++j) {
      const double* const above = m_factor.data() + m_start[j];
      double value = line[j];
      for (int i = std::max(m_skyline[k], m_skyline[j]); i < j; ++i) value -= line[i] * above[i];
      line[j] = value;  // stays multiplied by the pivot until the row is complete
    }
    for (int j = m_skyline[k]; j < k; ++j) {
      const double scaled = line[j] / m_factor[m_start[j] + j];
      left -= scaled * line[j];
      line[j] = scaled;
    }
    if (!(left > 0)) return false;
    line[k] = left;
  }
  return true;
}

// Sets the pushes of the free rows so that the bodies do not approach along them. Refines them until the
// regularisation has no effect.
bool RestSolver::solveFree() {
  m_free.clear();
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    m_index[i] = -1;
    if (m_side[i] == Side::kFree) {
      m_index[i] = static_cast<int>(m_free.size());
      m_free.push_back(static_cast<int>(i));
    } else {
      m_rows[i].push = m_side[i] == Side::kLow ? m_low[i] : m_high[i];
    }
  }
  if (m_free.empty()) {
    updateChange();
    return true;
  }
  if (!factorise()) return false;
  const int count = static_cast<int>(m_free.size());
  m_right.resize(count);
  double error = kUnbounded;
  for (int round = 0; round < kRefinements; ++round) {
    if (!spend(2 * static_cast<double>(m_factor.size()) + kRowPrice * static_cast<double>(m_rows.size())))
      return false;
    updateChange();
    double worst = 0;
    for (int k = 0; k < count; ++k) {
      m_right[k] = -rateOf(m_rows[m_free[k]]);
      worst = std::max(worst, std::fabs(m_right[k]));
    }
    if (worst == 0 || (round > 1 && worst > 0.5 * error)) break;  // the accuracy cannot be improved further
    error = worst;
    for (int k = 0; k < count; ++k) {
      const double* const line = m_factor.data() + m_start[k];
      for (int j = m_skyline[k]; j < k; ++j) m_right[k] -= line[j] * m_right[j];
    }
    for (int k = 0; k < count; ++k) m_right[k] /= m_factor[m_start[k] + k];
    for (int k = count - 1; k >= 0; --k) {
      const double* const line = m_factor.data() + m_start[k];
      for (int j = m_skyline[k]; j < k; ++j) m_right[j] -= line[j] * m_right[k];
    }
    for (int k = 0; k < count; ++k) m_rows[m_free[k]].push += m_right[k];
  }
  updateChange();
  return true;
}

bool RestSolver::solveWithinBounds() {
  const auto count = static_cast<int>(m_rows.size());
  int fewest = count + 1, patience = 4;
  for (int round = 0; round < 60 + 4 * count; ++round) {
    if (!spend(kRowPrice * count) || !solveFree()) return false;
    double largest = 0;
    for (const RestRow& row : m_rows) largest = std::max(largest, std::fabs(row.push));
    const double push_slack = 1e-13 * largest, rate_slack = 1e-13 * m_bias_scale;
    const auto wrong = [&](int i) {
      const double push = m_rows[i].push;
      if (m_side[i] == Side::kFree) return push < m_low[i] - push_slack || push > m_high[i] + push_slack;
      if (m_low[i] == m_high[i]) return false;
      const double rate = rateOf(m_rows[i]);
      return m_side[i] == Side::kLow ? rate < -rate_slack : rate > rate_slack;
    };
    const auto flip = [&](int i) {
      m_side[i] = m_side[i] != Side::kFree    ? Side::kFree
                  : m_rows[i].push < m_low[i] ? Side::kLow
                                              : Side::kHigh;
    };
    int bad = 0, last = -1;
    for (int i = 0; i < count; ++i) {
      if (wrong(i)) ++bad, last = i;
    }
    if (bad == 0) return true;
    if (bad < fewest) {
      fewest = bad;
      patience = 4;
    } else if (--patience < 0) {  // then rows are changed one at a time, which cannot cycle
      flip(last);
      continue;
    }
    m_index.resize(m_rows.size());
    for (int i = 0; i < count; ++i) m_index[i] = wrong(i);
    for (int i = 0; i < count; ++i) {
      if (m_index[i]) flip(i);
    }
  }
  return false;
}

// Sets the friction bounds from the normal pushes. Returns true if they are unchanged. Changes are relaxed by
// Irons and Tuck's factor (1969), because the iteration is mostly linear, and slow if a body is wedged.
bool RestSolver::setFrictionBounds(int round) {
  double largest = 0, product = 0, square = 0;
  bool is_same = true;
  for (const RestRow& row : m_rows) largest = std::max(largest, std::fabs(row.push));
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const RestRow& row = m_rows[i];
    if (row.normal < 0) continue;
    const double off = row.friction * std::max(m_rows[row.normal].push, 0.0) - m_limit[i];
    is_same = is_same && std::fabs(off) <= 1e-14 * (1 + row.friction) * largest;
    product += m_off[i] * (off - m_off[i]);
    square += (off - m_off[i]) * (off - m_off[i]);
    m_off[i] = off;
  }
  if (is_same) return true;
  m_relaxation = round < 2 || square == 0 ? 1 : std::clamp(-m_relaxation * product / square, 0.2, 50.0);
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const RestRow& row = m_rows[i];
    if (row.normal < 0) continue;
    m_limit[i] = std::max(m_limit[i] + m_relaxation * m_off[i], 0.0);
    m_low[i] = row.slip < 0 ? m_limit[i] : -m_limit[i];
    m_high[i] = row.slip > 0 ? -m_limit[i] : m_limit[i];
    if (m_low[i] == m_high[i]) {
      m_side[i] = Side::kLow;
    } else if (m_side[i] == Side::kLow && row.slip == 0 && rateOf(row) <= 1e-13 * m_bias_scale) {
      m_side[i] = Side::kFree;
    }
  }
  return false;
}

// Projected Gauss–Seidel sweeps, the fallback if the direct solution fails.
void RestSolver::sweep() {
  updateChange();
  for (int round = 0; round < kSweeps; ++round) {
    if (!spend(kRowPrice * static_cast<double>(m_rows.size()))) return;
    for (std::size_t i = 0; i < m_rows.size(); ++i) {
      RestRow& row = m_rows[i];
      if (row.normal >= 0) {
        const double most = row.friction * std::max(m_rows[row.normal].push, 0.0);
        m_low[i] = row.slip < 0 ? most : -most;
        m_high[i] = row.slip > 0 ? -most : most;
      }
      const double own = couple(row, row);
      if (!(own > 0)) continue;
      const double push = std::clamp(row.push - rateOf(row) / own, m_low[i], m_high[i]);
      const Vec2 more = (push - row.push) * row.direction;
      row.push = push;
      if (row.first >= 0) m_change[row.first] -= m_inverse_masses[row.first] * more;
      if (row.second >= 0) m_change[row.second] += m_inverse_masses[row.second] * more;
    }
  }
}

bool RestSolver::solve(const std::vector<double>& inverse_masses, double most_work) {
  const std::size_t count = m_rows.size();
  m_work = 0;
  m_most_work = most_work;
  m_is_too_costly = false;
  m_inverse_masses = inverse_masses;
  m_change.assign(inverse_masses.size(), {});
  m_effort.assign(inverse_masses.size(), 0);
  m_low.assign(count, 0);
  m_high.assign(count, 0);
  m_limit.assign(count, 0);
  m_off.assign(count, 0);
  m_side.assign(count, Side::kLow);
  m_index.assign(count, -1);
  m_rows_begin.assign(inverse_masses.size() + 1, 0);
  m_bias_scale = 0;
  bool has_friction = false;
  for (std::size_t i = 0; i < count; ++i) {
    RestRow& row = m_rows[i];
    row.push = 0;
    if (row.normal < 0) {
      m_high[i] = kUnbounded;
      m_side[i] = Side::kFree;
    } else {
      has_friction = true;
    }
    m_bias_scale = std::max(m_bias_scale, std::fabs(row.bias));
    for (const int body : {row.first, row.second}) {
      if (body >= 0) ++m_rows_begin[body + 1];
    }
  }
  for (std::size_t i = 1; i < m_rows_begin.size(); ++i) m_rows_begin[i] += m_rows_begin[i - 1];
  m_rows_of.resize(m_rows_begin.back());
  for (std::size_t i = count; i-- > 0;) {  // backwards, so that the rows of each body are in ascending order
    for (const int body : {m_rows[i].first, m_rows[i].second}) {
      if (body >= 0) m_rows_of[--m_rows_begin[body + 1]] = static_cast<int>(i);
    }
  }
  // The loop has left the start of each body's rows at the index of the next body; move all of them back.
  for (std::size_t i = 0; i + 1 < m_rows_begin.size(); ++i) m_rows_begin[i] = m_rows_begin[i + 1];
  m_rows_begin.back() = static_cast<int>(m_rows_of.size());

  for (int round = 0; round < kFrictionRounds; ++round) {
    if (!solveWithinBounds()) break;
    if (!has_friction || setFrictionBounds(round)) return true;
  }
  sweep();
  if (m_is_too_costly) {
    for (RestRow& row : m_rows) row.push = 0;
    updateChange();
  }
  return false;
}

}  // namespace naiad::physics
