#include "physics/rigid/RigidDirect.h"

#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// Stiffness of a row, in units of the largest mass. Each round divides the remaining error by about this
// factor. With 1e4, the matrix still has enough of a double's digits.
constexpr double kStiffness = 1e4;
constexpr double kRounding = 1e-14;  // precision of a sum of impulses, relative to the largest one
constexpr int kSpareRounds = 2;      // limit of further rounds that make velocities and impulses agree
constexpr int kFrictionRounds = 8;   // limit of further rounds that make friction agree with normal impulses
constexpr std::size_t kFewBodies =
    4;  // only for groups of at most this many bodies; others converge too slowly

}  // namespace

// The row's Jacobian at one of its bodies.
struct RigidDirect::Lever {
  Two low;
  double high;
  Lever times(const Lever& by) const { return Lever{low * by.low, high * by.high}; }
};

// A block of three rows and columns of the matrix.
struct RigidDirect::Corner {
  Two low[3];
  double high[3];
  void add(double k, const Lever& p, const Lever& q) {
    const double parts[3] = {k * p.low[0], k * p.low[1], k * p.high};
    for (int r = 0; r < 3; ++r) {
      low[r] += parts[r] * q.low;
      high[r] += parts[r] * q.high;
    }
  }
  // Adds the row to the block of a single body. Entries above the diagonal are not used: high[0] and high[1].
  void addSquare(double k, const Lever& p) {
    low[0] += k * p.low[0] * p.low;
    low[1] += k * p.low[1] * p.low;
    low[2] += k * p.high * p.low;
    high[2] += k * p.high * p.high;
  }
};

RigidDirect::Lever RigidDirect::leverA(const DirectRow& row) {
  return Lever{Two{-row.n.x, -row.n.y}, row.ja};
}
RigidDirect::Lever RigidDirect::leverB(const DirectRow& row) {
  return Lever{Two{row.n.x, row.n.y}, row.jb};
}

void RigidDirect::begin(std::span<const int> bodies, std::span<const RigidState> states) {
  for (const int body : m_bodies) m_local[at(body)] = -1;
  m_bodies.assign(bodies.begin(), bodies.end());
  m_local.resize(states.size(), -1);
  m_rows.clear();
  m_velocity.resize(bodies.size());
  m_mass.resize(bodies.size());
  double largest = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const RigidState& s = states[at(bodies[i])];
    m_local[at(bodies[i])] = static_cast<std::int32_t>(i);
    const double mass = s.inverse_mass > 0 ? 1 / s.inverse_mass : 0;
    const double inertia = s.inverse_inertia > 0 ? 1 / s.inverse_inertia : 0;
    m_velocity[i] = {{s.velocity.x, s.velocity.y, s.spin}};
    m_mass[i] = {{mass, mass, inertia}};
    largest = std::max(largest, mass > 0 ? mass : inertia);
  }
  m_largest_mass = largest;
}

std::int32_t RigidDirect::localOf(int body) const {
  return body >= 0 && at(body) < m_local.size() ? m_local[at(body)] : -1;
}

double RigidDirect::order() {
  const std::size_t count = m_bodies.size();
  m_begin.assign(count + 1, 0);
  for (const DirectRow& row : m_rows) {
    if (row.a < 0 || row.b < 0) continue;
    ++m_begin[at(row.a) + 1], ++m_begin[at(row.b) + 1];
  }
  for (std::size_t i = 1; i <= count; ++i) m_begin[i] += m_begin[i - 1];
  m_next.resize(at(m_begin[count]));
  m_rank.assign(m_begin.begin(), m_begin.end() - 1);
  for (const DirectRow& row : m_rows) {
    if (row.a < 0 || row.b < 0) continue;
    m_next[at(m_rank[at(row.a)]++)] = row.b;
    m_next[at(m_rank[at(row.b)]++)] = row.a;
  }
  // Traverses bodies breadth first, twice. The second traversal starts at the last body of the first one.
  const auto spread = [&](std::int32_t start) {
    m_rank.assign(count, -1);
    m_sequence.clear();
    for (std::int32_t seed = -1; seed < static_cast<std::int32_t>(count); ++seed) {
      const std::int32_t root = seed < 0 ? start : seed;
      if (m_rank[at(root)] >= 0) continue;
      m_rank[at(root)] = static_cast<std::int32_t>(m_sequence.size());
      m_sequence.push_back(root);
      for (std::size_t head = m_sequence.size() - 1; head < m_sequence.size(); ++head) {
        const std::int32_t here = m_sequence[head];
        for (std::int32_t i = m_begin[at(here)]; i < m_begin[at(here) + 1]; ++i) {
          const std::int32_t there = m_next[at(i)];
          if (m_rank[at(there)] >= 0) continue;
          m_rank[at(there)] = static_cast<std::int32_t>(m_sequence.size());
          m_sequence.push_back(there);
        }
      }
    }
  };
  spread(0);
  spread(m_sequence.back());
  m_first.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::int32_t least = m_rank[i];
    for (std::int32_t k = m_begin[i]; k < m_begin[i + 1]; ++k)
      least = std::min(least, m_rank[at(m_next[at(k)])]);
    for (std::int32_t c = 0; c < 3; ++c) m_first[at(3 * m_rank[i] + c)] = 3 * least;
  }
  m_row_at.resize(3 * count);
  std::int64_t stored = 0;
  double cost = 0;
  for (std::size_t i = 0; i < 3 * count; ++i) {
    const std::int64_t width = static_cast<std::int64_t>(i) - m_first[i] + 1;
    m_row_at[i] = stored - m_first[i];
    stored += width;
    cost += 0.5 * static_cast<double>(width * width);
  }
  m_matrix.resize(at(stored));
  m_right.resize(3 * count);
  return cost;
}

double RigidDirect::speedOf(const DirectRow& row) const {
  double speed = -row.target;
  if (row.a >= 0) {
    const Velocity& v = m_velocity[at(row.a)];
    speed += row.ja * v.x[2] - row.n.x * v.x[0] - row.n.y * v.x[1];
  }
  if (row.b >= 0) {
    const Velocity& v = m_velocity[at(row.b)];
    speed += row.jb * v.x[2] + row.n.x * v.x[0] + row.n.y * v.x[1];
  }
  return speed;
}

// Sets the rows' stiffnesses. If a spring's is larger than the mass that it holds, it is used instead.
void RigidDirect::setStiffnesses() {
  m_held_mass.assign(m_bodies.size(), m_largest_mass);
  for (const DirectRow& row : m_rows) {
    if (row.softness <= 0) continue;
    for (const std::int32_t body : {row.a, row.b}) {
      if (body >= 0) m_held_mass[at(body)] = std::max(m_held_mass[at(body)], 1 / row.softness);
    }
  }
  m_stiffness.resize(m_rows.size());
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    double mass = m_largest_mass;
    for (const std::int32_t body : {m_rows[i].a, m_rows[i].b}) {
      if (body >= 0) mass = std::max(mass, m_held_mass[at(body)]);
    }
    m_stiffness[i] = kStiffness * mass;
  }
}

// Finds which rows push with their stiffness (kFree), which are at a bound, and their impulses at the present
// velocities. Returns true if no row changed. A row that goes from one bound to the other is free in between.
bool RigidDirect::setForces(bool is_first) {
  bool is_same = !is_first;
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const DirectRow& row = m_rows[i];
    double low = row.low, high = row.high;
    if (row.normal >= 0) {
      high = row.friction * std::max(m_guess[at(row.normal)], 0.0);
      low = -high;
    }
    const Side before = m_side[i];
    Side side = Side::kLow;
    double wanted = low;
    if (low != high) {
      wanted = row.softness > 0 ? row.before - speedOf(row) / row.softness
                                : m_guess[i] - m_stiffness[i] * speedOf(row);
      side = wanted < low ? Side::kLow : wanted > high ? Side::kHigh : Side::kFree;
      if (is_first || (before != Side::kFree && side != Side::kFree && side != before)) side = Side::kFree;
    }
    if (is_first || (side == Side::kFree) != (before == Side::kFree))
      m_changed = std::min(m_changed, firstOf(row));
    m_side[i] = side;
    m_force[i] = side == Side::kFree ? wanted : side == Side::kLow ? low : high;
    is_same = is_same && side == before;
  }
  return is_same;
}

// True if the frictions agree with the limits by the present normal impulses, those of m_guess. The limits by
// the impulses that were known before may be wrong: 0 for a new contact, too large for one that opens.
bool RigidDirect::areFrictionsInBounds(double tolerance) const {
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const DirectRow& row = m_rows[i];
    if (row.normal < 0) continue;
    const double most = row.friction * std::max(m_guess[at(row.normal)], 0.0), own = std::fabs(m_force[i]);
    double mass = m_largest_mass;
    for (const std::int32_t body : {row.a, row.b}) {
      if (body >= 0 && m_mass[at(body)].x[0] > 0) mass = std::min(mass, m_mass[at(body)].x[0]);
    }
    if (own > most + tolerance * mass) return false;
    if (m_side[i] != Side::kFree && own < most - tolerance * mass) return false;
  }
  return true;
}

// Returns the lowest rank of the row's bodies.
std::int32_t RigidDirect::firstOf(const DirectRow& row) const {
  std::int32_t first = static_cast<std::int32_t>(m_bodies.size());
  for (const std::int32_t body : {row.a, row.b}) {
    if (body >= 0) first = std::min(first, m_rank[at(body)]);
  }
  return first;
}

// Fills the matrix from the rows of the body m_changed on; the rows before them stay factored.
void RigidDirect::assemble() {
  const auto row = 3 * static_cast<std::size_t>(m_changed);
  if (row == m_first.size()) return;
  std::fill(m_matrix.begin() + m_row_at[row] + m_first[row], m_matrix.end(), 0.0);
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (m_rank[i] < m_changed) continue;
    for (std::int32_t c = 0; c < 3; ++c) {
      const std::int64_t k = 3 * m_rank[i] + c;
      m_matrix[at(m_row_at[at(k)] + k)] = m_mass[i].x[c] > 0 ? m_mass[i].x[c] : 1;
    }
  }
  for (std::size_t i = 0, end = 0; i < m_rows.size(); i = end) {  // the rows of a contact, or of a joint
    for (end = i + 1; end < m_rows.size(); ++end) {
      if (m_rows[end].a != m_rows[i].a || m_rows[end].b != m_rows[i].b) break;
    }
    addStiffness(i, end);
  }
}

// Adds the stiffness of rows between two bodies. Reads and writes the three blocks of the matrix only once,
// but adds in the order of the rows, so that each entry has equal bits.
void RigidDirect::addStiffness(std::size_t begin, std::size_t end) {
  const std::int32_t a = m_rows[begin].a, b = m_rows[begin].b;
  const bool has_a = a >= 0, has_b = b >= 0;
  if (!(has_a && m_rank[at(a)] >= m_changed) && !(has_b && m_rank[at(b)] >= m_changed)) return;
  const auto isFree = [&](Side side) { return side == Side::kFree; };
  if (std::none_of(&m_side[begin], &m_side[begin] + (end - begin), isFree)) return;
  const bool is_a_later = has_a && has_b && m_rank[at(a)] > m_rank[at(b)];
  const std::int32_t later = is_a_later ? a : b, earlier = is_a_later ? b : a;
  const Lever free_a = freeOf(a), free_b = freeOf(b);
  Corner of_a = cornerOf(a, a), of_b = cornerOf(b, b), between = cornerOf(later, earlier);
  for (std::size_t i = begin; i < end; ++i) {
    if (m_side[i] != Side::kFree) continue;
    const DirectRow& row = m_rows[i];
    const double k = row.softness > 0 ? 1 / row.softness : m_stiffness[i];
    const Lever p = leverA(row).times(free_a), q = leverB(row).times(free_b);
    of_a.addSquare(k, p);
    of_b.addSquare(k, q);
    between.add(k, is_a_later ? p : q, is_a_later ? q : p);
  }
  setCorner(a, a, of_a);
  setCorner(b, b, of_b);
  setCorner(later, earlier, between);
}

// Returns 1 for each coordinate of the body that can change, and 0 for the others or if there is no body.
RigidDirect::Lever RigidDirect::freeOf(std::int32_t body) const {
  if (body < 0) return Lever{Two{}, 0};
  const auto isFree = [&](std::size_t c) { return m_mass[at(body)].x[c] > 0 ? 1.0 : 0.0; };
  return Lever{Two{isFree(0), isFree(1)}, isFree(2)};
}

RigidDirect::Corner RigidDirect::cornerOf(std::int32_t i, std::int32_t j) {
  Corner corner = {};
  if (i < 0 || j < 0 || m_rank[at(i)] < m_changed) return corner;
  const std::int64_t row = 3 * static_cast<std::int64_t>(m_rank[at(i)]);
  const std::int64_t column = 3 * static_cast<std::int64_t>(m_rank[at(j)]);
  for (std::int64_t r = 0; r < 3; ++r) {
    const double* const line = lineOf(row + r) + column;
    corner.low[r][0] = line[0];
    if (i != j || r > 0) corner.low[r][1] = line[1];
    if (i != j || r > 1) corner.high[r] = line[2];
  }
  return corner;
}

void RigidDirect::setCorner(std::int32_t i, std::int32_t j, const Corner& corner) {
  if (i < 0 || j < 0 || m_rank[at(i)] < m_changed) return;
  const std::int64_t row = 3 * static_cast<std::int64_t>(m_rank[at(i)]);
  const std::int64_t column = 3 * static_cast<std::int64_t>(m_rank[at(j)]);
  for (std::int64_t r = 0; r < 3; ++r) {
    double* const line = lineOf(row + r) + column;
    line[0] = corner.low[r][0];
    if (i != j || r > 0) line[1] = corner.low[r][1];
    if (i != j || r > 1) line[2] = corner.high[r];
  }
}

// Factors the three rows of a body at once, because they start at the same column. Adds in the order of a
// factorisation row by row, so that entries have equal bits. Returns false if a pivot is not positive.
bool RigidDirect::factor() {
  const auto bodies = static_cast<std::int64_t>(m_first.size() / 3);
  m_block.resize(m_first.size());
  for (std::int64_t body = m_changed; body < bodies; ++body) {
    const std::int64_t first = m_first[at(3 * body)];
    const double *const one = lineOf(3 * body), *const two = lineOf(3 * body + 1),
                        *const three = lineOf(3 * body + 2);
    for (std::int64_t i = first; i < 3 * body; ++i) m_block[at(i)] = {Two{one[i], two[i]}, Two{three[i], 0}};
    for (std::int64_t column = first; column < 3 * body; column += 3) reduceBlock(first, column);
    if (!factorBlock(first, 3 * body)) return false;
  }
  m_changed = static_cast<std::int32_t>(bodies);
  return true;
}

// Reduces three columns by those before them. Entries stay multiplied by their pivots until factorBlock().
void RigidDirect::reduceBlock(std::int64_t first, std::int64_t column) {
  const double *const one = lineOf(column), *const two = lineOf(column + 1),
                      *const three = lineOf(column + 2);
  Block* const block = m_block.data();
  Two a = block[column].low, b = block[column + 1].low, c = block[column + 2].low;
  Two d = block[column].high, e = block[column + 1].high, f = block[column + 2].high;
  for (std::int64_t i = std::max<std::int64_t>(first, m_first[at(column)]); i < column; ++i) {
    const Two low = block[i].low, high = block[i].high;
    a -= low * one[i], b -= low * two[i], c -= low * three[i];
    d -= high * one[i], e -= high * two[i], f -= high * three[i];
  }
  b -= a * two[column], e -= d * two[column];
  c -= a * three[column], f -= d * three[column];
  c -= b * three[column + 1], f -= e * three[column + 1];
  block[column] = {a, d}, block[column + 1] = {b, e}, block[column + 2] = {c, f};
}

// Divides three rows by the pivots before them, and computes their own pivots, which are stored inverted.
bool RigidDirect::factorBlock(std::int64_t first, std::int64_t row) {
  double *const one = lineOf(row), *const two = lineOf(row + 1), *const three = lineOf(row + 2);
  Two a = {one[row], two[row]}, b = {0, two[row + 1]};
  double a_three = three[row], b_three = three[row + 1], c_three = three[row + 2];
  for (std::int64_t j = first; j < row; ++j) {
    const Block& here = m_block[at(j)];
    const double pivot = lineOf(j)[j];
    one[j] = here.low[0] * pivot, two[j] = here.low[1] * pivot, three[j] = here.high[0] * pivot;
    a -= here.low * one[j], b -= here.low * two[j];
    a_three -= here.high[0] * one[j], b_three -= here.high[0] * two[j], c_three -= here.high[0] * three[j];
  }
  if (!(a[0] > 0)) return false;
  one[row] = 1 / a[0];
  two[row] = a[1] * one[row];
  const double second = b[1] - a[1] * two[row];
  if (!(second > 0)) return false;
  two[row + 1] = 1 / second;
  b_three -= a_three * two[row];
  three[row] = a_three * one[row];
  three[row + 1] = b_three * two[row + 1];
  c_three = (c_three - three[row] * a_three) - three[row + 1] * b_three;
  if (!(c_three > 0)) return false;
  three[row + 2] = 1 / c_three;
  return true;
}

// Solves the factored system for m_right in place, with the three rows of a body at once.
void RigidDirect::solveFactored() {
  const auto count = static_cast<std::int64_t>(m_first.size());
  double* const right = m_right.data();
  for (std::int64_t k = 0; k < count; k += 3) {
    const double *const one = lineOf(k), *const two = lineOf(k + 1), *const three = lineOf(k + 2);
    double x = right[k], y = right[k + 1], z = right[k + 2];
    for (std::int64_t j = m_first[at(k)]; j < k; ++j)
      x -= one[j] * right[j], y -= two[j] * right[j], z -= three[j] * right[j];
    y -= two[k] * x;
    z = (z - three[k] * x) - three[k + 1] * y;
    right[k] = x, right[k + 1] = y, right[k + 2] = z;
  }
  for (std::int64_t k = 0; k < count; ++k) right[k] *= lineOf(k)[k];
  for (std::int64_t k = count - 3; k >= 0; k -= 3) {
    const double *const one = lineOf(k), *const two = lineOf(k + 1), *const three = lineOf(k + 2);
    const double z = right[k + 2], y = right[k + 1] - three[k + 1] * z;
    const double x = (right[k] - three[k] * z) - two[k] * y;
    for (std::int64_t j = m_first[at(k)]; j < k; ++j)
      right[j] = ((right[j] - three[j] * z) - two[j] * y) - one[j] * x;
    right[k] = x, right[k + 1] = y;
  }
}

void RigidDirect::computeResidual() {
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    for (std::int32_t c = 0; c < 3; ++c) {
      m_right[at(3 * m_rank[i] + c)] = m_mass[i].x[c] * (m_start[i].x[c] - m_velocity[i].x[c]);
    }
  }
  for (std::size_t i = 0; i < m_rows.size(); ++i) {
    const DirectRow& row = m_rows[i];
    const double more = m_force[i] - row.impulse;
    if (more == 0) continue;
    const auto give = [&](std::int32_t body, const Lever& lever) {
      if (body < 0) return;
      const double* const mass = m_mass[at(body)].x;
      double* const right = &m_right[at(3 * m_rank[at(body)])];
      if (mass[0] > 0) right[0] += more * lever.low[0];
      if (mass[1] > 0) right[1] += more * lever.low[1];
      if (mass[2] > 0) right[2] += more * lever.high;
    };
    give(row.a, leverA(row));
    give(row.b, leverB(row));
  }
}

double RigidDirect::worstError() const {
  double worst = 0;
  for (const DirectRow& row : m_rows) {
    double low = row.low, high = row.high;
    if (row.normal >= 0) {
      high = row.friction * std::max(m_rows[at(row.normal)].impulse, 0.0);
      low = -high;
    }
    const double speed = speedOf(row) + row.softness * (row.impulse - row.before);
    const bool is_outside =
        row.impulse < low - kRounding * std::fabs(low) || row.impulse > high + kRounding * std::fabs(high);
    if (is_outside && m_bodies.size() <= kFewBodies)  // because the limits have changed
      return std::numeric_limits<double>::infinity();
    if (row.impulse <= low && row.impulse >= high) continue;
    if (row.impulse <= low) {
      worst = std::max(worst, -speed);
    } else if (row.impulse >= high) {
      worst = std::max(worst, speed);
    } else {
      worst = std::max(worst, std::fabs(speed));
    }
  }
  return worst;
}

bool RigidDirect::solve(std::span<RigidState> states, double tolerance, int most_rounds, int& rounds) {
  const std::size_t count = m_rows.size();
  m_start = m_velocity;
  m_guess.resize(count);
  m_force.resize(count);
  m_side.assign(count, Side::kFree);
  for (std::size_t i = 0; i < count; ++i) m_guess[i] = m_rows[i].impulse + m_rows[i].expected;
  setStiffnesses();
  // A body is balanced if its velocity agrees with the impulses on it. For the stiffest rows, the last digit
  // of a speed corresponds to an impulse that would throw a light body.
  double largest = 0;
  const auto isBalanced = [&](std::size_t i) {
    for (std::int32_t c = 0; c < 3; ++c) {
      const double most = tolerance * m_mass[i].x[c] + kRounding * largest;
      if (std::fabs(m_right[at(3 * m_rank[i] + c)]) > most) return false;
    }
    return true;
  };
  const auto areBalanced = [&] {
    for (std::size_t i = 0; i < count; ++i) {
      largest = std::max({largest, std::fabs(m_force[i]), std::fabs(m_rows[i].impulse)});
    }
    computeResidual();
    for (std::size_t i = 0; i < m_bodies.size(); ++i) {
      if (!isBalanced(i)) return false;
    }
    return true;
  };
  int spare_rounds = kSpareRounds, friction_rounds = kFrictionRounds;
  bool is_found = false, is_left = false;  // is_left: a further round has left the solution that was found
  m_changed = 0;
  setForces(true);
  bool is_factored = false;
  for (rounds = 1; rounds <= most_rounds; ++rounds) {
    is_left = true;
    if (!is_factored) {
      assemble();
      if (!factor()) break;
      is_factored = true;
    }
    computeResidual();
    solveFactored();
    for (std::size_t i = 0; i < m_bodies.size(); ++i) {
      for (std::int32_t c = 0; c < 3; ++c) m_velocity[i].x[c] += m_right[at(3 * m_rank[i] + c)];
    }
    if (!setForces(false)) {
      is_factored = false;
      continue;
    }
    // The set of pushing rows is right. Tests whether they reach their target speeds.
    m_guess = m_force;
    double worst = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (m_side[i] == Side::kFree && m_rows[i].softness == 0)
        worst = std::max(worst, std::fabs(speedOf(m_rows[i])));
    }
    if (worst <= tolerance) {
      is_found = true;
      is_left = false;
      const bool are_balanced = areBalanced();
      const bool are_in_bounds = m_bodies.size() > kFewBodies || areFrictionsInBounds(tolerance);
      if ((are_balanced && are_in_bounds) || rounds == most_rounds) break;
      if (are_in_bounds ? spare_rounds-- == 0 : friction_rounds-- == 0) break;
      m_found_velocity = m_velocity;
      m_found_force = m_force;
    }
    is_factored = setForces(false);
  }
  if (!is_found) return false;
  if (is_left) {
    m_velocity.swap(m_found_velocity);
    m_force.swap(m_found_force);
    areBalanced();
  }
  // Applies the impulses to the bodies, which conserves the momentum to the last digit. Bodies that are not
  // balanced get the velocities of the solution instead.
  for (std::size_t i = 0; i < count; ++i) {
    DirectRow& row = m_rows[i];
    const double more = m_force[i] - row.impulse;
    row.impulse = m_force[i];
    if (row.a >= 0) {
      RigidState& a = states[at(m_bodies[at(row.a)])];
      a.velocity -= (a.inverse_mass * more) * row.n;
      a.spin += a.inverse_inertia * row.ja * more;
    }
    if (row.b >= 0) {
      RigidState& b = states[at(m_bodies[at(row.b)])];
      b.velocity += (b.inverse_mass * more) * row.n;
      b.spin += b.inverse_inertia * row.jb * more;
    }
  }
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    if (isBalanced(i)) continue;
    RigidState& s = states[at(m_bodies[i])];
    s.velocity = {m_velocity[i].x[0], m_velocity[i].x[1]};
    s.spin = m_velocity[i].x[2];
  }
  return true;
}

}  // namespace naiad::physics
