#include "physics/numerics/JointMatrix.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

constexpr double kDependent = 1e-11;  // a pivot below this part of the diagonal is only rounding

using Neighbours = std::vector<std::vector<int>>;

bool isMovable(std::span<const JointMass> masses, int body) {
  return body >= 0 && (masses[at(body)].inverse_mass > 0 || masses[at(body)].inverse_inertia > 0);
}

std::vector<std::vector<int>> rowsAtBodies(std::span<const JointRow> rows,
                                           std::span<const JointMass> masses) {
  std::vector<std::vector<int>> at_body(masses.size());
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    const JointRow& row = rows[at(i)];
    if (isMovable(masses, row.a)) at_body[at(row.a)].push_back(i);
    if (isMovable(masses, row.b)) at_body[at(row.b)].push_back(i);
  }
  return at_body;
}

void insertSorted(std::vector<int>& list, int value) {
  const auto place = std::lower_bound(list.begin(), list.end(), value);
  if (place == list.end() || *place != value) list.insert(place, value);
}

Neighbours neighboursOf(std::span<const JointRow> rows, std::span<const JointMass> masses) {
  Neighbours neighbours(rows.size());
  for (const std::vector<int>& group : rowsAtBodies(rows, masses)) {
    for (const int i : group) {
      for (const int k : group) {
        if (i != k) insertSorted(neighbours[at(i)], k);
      }
    }
  }
  return neighbours;
}

// Returns how many pairs of the row's neighbours are not neighbours of each other.
int fillOf(const Neighbours& neighbours, int i) {
  const std::vector<int>& list = neighbours[at(i)];
  int fill = 0;
  for (std::size_t p = 0; p < list.size(); ++p) {
    const std::vector<int>& theirs = neighbours[at(list[p])];
    for (std::size_t q = p + 1; q < list.size(); ++q) {
      if (!std::binary_search(theirs.begin(), theirs.end(), list[q])) ++fill;
    }
  }
  return fill;
}

double diagonalOf(const JointRow& row, const JointMass* masses, double softness, double regularisation) {
  const double square = dot(row.n, row.n);
  double sum = masses[row.b].inverse_mass * square + masses[row.b].inverse_inertia * row.jb * row.jb;
  if (row.a >= 0)
    sum += masses[row.a].inverse_mass * square + masses[row.a].inverse_inertia * row.ja * row.ja;
  return (sum + softness) * (1 + regularisation);
}

}  // namespace

// Eliminates the row with the least fill first. Finds an order without fill if there is one, as for trees.
std::vector<int> eliminationOrder(std::span<const JointRow> rows, std::span<const JointMass> masses) {
  Neighbours neighbours = neighboursOf(rows, masses);
  std::vector<int> fill(rows.size());
  std::set<std::pair<int, int>> queue;
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    fill[at(i)] = fillOf(neighbours, i);
    queue.emplace(fill[at(i)], i);
  }
  std::vector<int> order;
  order.reserve(rows.size());
  while (!queue.empty()) {
    const auto [its_fill, i] = *queue.begin();
    queue.erase(queue.begin());
    order.push_back(i);
    const std::vector<int> list = std::move(neighbours[at(i)]);
    neighbours[at(i)].clear();
    std::set<int> stale(list.begin(), list.end());
    for (const int k : list) {
      std::vector<int>& theirs = neighbours[at(k)];
      theirs.erase(std::lower_bound(theirs.begin(), theirs.end(), i));
      for (const int other : list) {
        if (other != k) insertSorted(theirs, other);
      }
      if (its_fill > 0) stale.insert(theirs.begin(), theirs.end());
    }
    for (const int k : stale) {
      queue.erase({fill[at(k)], k});
      fill[at(k)] = fillOf(neighbours, k);
      queue.emplace(fill[at(k)], k);
    }
  }
  return order;
}

void JointMatrix::analyse(std::span<const JointRow> rows, std::span<const JointMass> masses) {
  m_size = static_cast<int>(rows.size());
  Neighbours neighbours = neighboursOf(rows, masses);
  Neighbours columns(rows.size());
  m_entries = 0;
  for (int i = 0; i < m_size; ++i) {
    for (const int k : neighbours[at(i)]) {
      if (k > i) columns[at(i)].push_back(k);
    }
    m_entries += static_cast<int>(columns[at(i)].size());
  }
  for (int j = 0; j < m_size; ++j) {  // rows below the first entry fill that entry's column
    const std::vector<int>& column = columns[at(j)];
    for (std::size_t p = 1; p < column.size(); ++p) insertSorted(columns[at(column[0])], column[p]);
  }
  m_begin.assign(1, 0);
  m_row.clear();
  for (const std::vector<int>& column : columns) {
    m_row.insert(m_row.end(), column.begin(), column.end());
    m_begin.push_back(static_cast<int>(m_row.size()));
  }
  const auto find = [&](int column, int row) {
    const auto first = m_row.begin() + m_begin[at(column)], last = m_row.begin() + m_begin[at(column) + 1];
    return static_cast<int>(std::lower_bound(first, last, row) - m_row.begin());
  };
  m_is_chain = m_size > 0 && filled() == m_size - 1;
  for (int j = 0; j + 1 < m_size && m_is_chain; ++j)
    m_is_chain = m_begin[at(j)] == j && m_row[at(j)] == j + 1;
  bool is_band = m_size > 1;
  for (int j = 0; j < m_size && is_band; ++j)
    is_band = m_begin[at(j)] == m_begin[at(j) + 1] || m_row[at(m_begin[at(j) + 1]) - 1] <= j + kBand;
  m_band.assign(is_band ? at(kBand * (m_size + kBand)) : 0, 0);
  m_targets.clear();
  for (const std::vector<int>& column : columns) {
    for (std::size_t p = 0; p < column.size(); ++p) {
      m_targets.push_back(~column[p]);
      for (std::size_t q = p + 1; q < column.size(); ++q) m_targets.push_back(find(column[p], column[q]));
    }
  }
  m_terms.clear();
  const auto groups = rowsAtBodies(rows, masses);
  for (int body = 0; body < static_cast<int>(groups.size()); ++body) {
    const std::vector<int>& group = groups[at(body)];
    for (std::size_t p = 0; p < group.size(); ++p) {
      for (std::size_t q = p + 1; q < group.size(); ++q) {
        const int i = group[p], k = group[q];
        const bool i_is_b = rows[at(i)].b == body, k_is_b = rows[at(k)].b == body;
        m_terms.push_back({find(i, k), i, k, body, i_is_b == k_is_b ? 1.0 : -1.0, i_is_b, k_is_b});
      }
    }
  }
  m_lower.assign(m_row.size(), 0);
  m_inverse.assign(rows.size(), 0);
  m_pivot.assign(rows.size(), 0);
}

// Computes the entries below the diagonal, before factoring.
void JointMatrix::setLower(const JointRow* rows, const JointMass* masses, const std::uint8_t* is_out) {
  std::fill(m_lower.begin(), m_lower.end(), 0.0);
  for (const Term& term : m_terms) {
    if (is_out != nullptr && (is_out[term.i] | is_out[term.k]) != 0) continue;
    const JointRow& i = rows[term.i];
    const JointRow& k = rows[term.k];
    const JointMass& mass = masses[term.body];
    m_lower[at(term.at)] += term.sign * mass.inverse_mass * dot(i.n, k.n) +
                            mass.inverse_inertia * (term.i_is_b ? i.jb : i.ja) * (term.k_is_b ? k.jb : k.ja);
  }
}

// Factors the matrix of a chain, whose rows have a single entry below the diagonal.
int JointMatrix::factorChain(const JointRow* rows, const JointMass* masses, double regularisation) {
  int dependent = 0;
  double taken = 0;  // from the row's pivot by the row before it
  for (int j = 0; j < m_size; ++j) {
    const double diagonal = diagonalOf(rows[j], masses, 0, regularisation), pivot = diagonal - taken;
    const bool is_good = pivot > kDependent * diagonal;
    const double inverse = is_good ? 1 / pivot : 0;
    dependent += is_good ? 0 : 1;
    m_inverse[at(j)] = inverse;
    if (j + 1 == m_size) break;
    const double scaled = m_lower[at(j)] * inverse;
    taken = scaled * m_lower[at(j)];
    m_lower[at(j)] = scaled;
  }
  return dependent;
}

int JointMatrix::factor(const JointRow* rows, const JointMass* masses, double regularisation) {
  setLower(rows, masses, nullptr);
  if (m_is_chain) return factorChain(rows, masses, regularisation);
  for (int i = 0; i < m_size; ++i)
    m_pivot[at(i)] = m_inverse[at(i)] = diagonalOf(rows[i], masses, 0, regularisation);
  return eliminate();
}

int JointMatrix::factor(const JointRow* rows, const JointMass* masses, const std::uint8_t* is_out,
                        const double* softness, double regularisation) {
  setLower(rows, masses, is_out);
  for (int i = 0; i < m_size; ++i) {
    m_pivot[at(i)] = m_inverse[at(i)] =
        is_out[i] != 0 ? 1 : diagonalOf(rows[i], masses, softness[i], regularisation);
  }
  return eliminate();
}

// Call when m_lower has the matrix, and m_pivot and m_inverse its diagonal.
int JointMatrix::eliminate() {
  const double* diagonal = m_inverse.data();
  int dependent = 0;
  const int* target = m_targets.data();
  for (int j = 0; j < m_size; ++j) {
    const int begin = m_begin[at(j)], end = m_begin[at(j) + 1];
    const double pivot = m_pivot[at(j)];
    double inverse = 0;
    if (pivot > kDependent * diagonal[j]) {
      inverse = 1 / pivot;
    } else {
      ++dependent;
    }
    for (int p = begin; p < end; ++p) {
      const double scaled = m_lower[at(p)] * inverse;
      m_pivot[at(~*target++)] -= scaled * m_lower[at(p)];
      for (int q = p + 1; q < end; ++q) m_lower[at(*target++)] -= scaled * m_lower[at(q)];
      m_lower[at(p)] = scaled;
    }
    m_inverse[at(j)] = inverse;
  }
  if (isBand()) {
    for (int j = 0; j < m_size; ++j) {
      for (int p = m_begin[at(j)]; p < m_begin[at(j) + 1]; ++p)
        m_band[at(kBand * (j + kBand) + m_row[at(p)] - j - 1)] = m_lower[at(p)];
    }
  }
  return dependent;
}

void JointMatrix::solve(double* x) const {
  if (m_is_chain) {
    const double* lower = m_lower.data();
    for (int j = 0; j + 1 < m_size; ++j) x[j + 1] -= lower[j] * x[j];
    x[m_size - 1] *= m_inverse[at(m_size - 1)];
    for (int j = m_size - 2; j >= 0; --j) x[j] = x[j] * m_inverse[at(j)] - lower[j] * x[j + 1];
    return;
  }
  if (isBand()) return solveBand(x);
  for (int j = 0; j < m_size; ++j) {
    const double value = x[j];
    for (int p = m_begin[at(j)]; p < m_begin[at(j) + 1]; ++p) x[m_row[at(p)]] -= m_lower[at(p)] * value;
  }
  for (int j = m_size - 1; j >= 0; --j) {
    double value = x[j] * m_inverse[at(j)];
    for (int p = m_begin[at(j)]; p < m_begin[at(j) + 1]; ++p) value -= m_lower[at(p)] * x[m_row[at(p)]];
    x[j] = value;
  }
}

// Like solve(), with the same operations in the same order. Values for the next rows stay in registers,
// because to load a value just stored takes longer than to compute a row.
void JointMatrix::solveBand(double* x) const {
  const double* column = m_band.data();  // starts with kBand columns of zeros
  double last = 0, second = 0, third = 0;
  for (int j = 0; j < m_size; ++j, column += kBand) {
    const double value =
        ((x[j] - column[2] * third) - column[kBand + 1] * second) - column[kBand + kBand] * last;
    third = second;
    second = last;
    x[j] = last = value;
  }
  last = second = third = 0;
  column = m_band.data() + at(kBand * (m_size + kBand - 1));
  for (int j = m_size - 1; j >= 0; --j, column -= kBand) {
    const double value =
        ((x[j] * m_inverse[at(j)] - column[0] * last) - column[1] * second) - column[2] * third;
    third = second;
    second = last;
    x[j] = last = value;
  }
}

}  // namespace naiad::physics
