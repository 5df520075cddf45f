#include "physics/numerics/ConjugateGradients.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace naiad::physics {

namespace {

constexpr int kLanes = 4;
using Lanes = float __attribute__((vector_size(16)));
using WideLanes = double __attribute__((vector_size(32)));

Lanes load(const float* p) {
  Lanes lanes;
  std::memcpy(&lanes, p, sizeof lanes);
  return lanes;
}

void store(float* p, Lanes lanes) {
  std::memcpy(p, &lanes, sizeof lanes);
}

/// Adds up floats as doubles, four at a time, in a fixed order.
class Sum {
 public:
  void add(Lanes lanes) { m_lanes += __builtin_convertvector(lanes, WideLanes); }
  double total() const { return (m_lanes[0] + m_lanes[2]) + (m_lanes[1] + m_lanes[3]); }

 private:
  WideLanes m_lanes = {};
};

int distanceOf(const ConjugateGradients::Pair& pair) {
  return std::abs(pair.a - pair.b);
}

std::vector<int> distancesOf(std::span<const ConjugateGradients::Pair> pairs) {
  std::vector<int> distances;
  for (const auto& pair : pairs) {
    const auto place = std::lower_bound(distances.begin(), distances.end(), distanceOf(pair));
    if (place == distances.end() || *place != distanceOf(pair)) distances.insert(place, distanceOf(pair));
  }
  return distances;
}

}  // namespace

int ConjugateGradients::diagonalsOf(std::span<const Pair> pairs) {
  return static_cast<int>(distancesOf(pairs).size());
}

void ConjugateGradients::resize(Points& points) const {
  const std::size_t size = at(m_margin + m_nodes + kLanes + m_margin);
  points.x.assign(size, 0), points.y.assign(size, 0);
}

void ConjugateGradients::resize(Blocks& blocks) const {
  const std::size_t size = at(m_margin + m_nodes + kLanes);
  blocks.xx.assign(size, 0), blocks.xy.assign(size, 0), blocks.yy.assign(size, 0);
}

void ConjugateGradients::resize(int nodes, std::span<const Pair> pairs) {
  const std::vector<int> distances = distancesOf(pairs);
  m_nodes = nodes;
  m_margin = distances.empty() ? 0 : distances.back();
  m_diagonals.resize(distances.size());
  for (std::size_t k = 0; k < distances.size(); ++k) {
    m_diagonals[k].distance = distances[k];
    resize(m_diagonals[k].blocks);
  }
  m_slots.clear();
  for (const Pair& pair : pairs) {
    const auto place = std::lower_bound(distances.begin(), distances.end(), distanceOf(pair));
    m_slots.push_back({static_cast<int>(place - distances.begin()), m_margin + std::min(pair.a, pair.b)});
  }
  m_diagonal.assign(at(nodes), {});
  resize(m_middle), resize(m_inverse);
  for (Points* points : {&m_solution, &m_residual, &m_direction, &m_product}) resize(*points);
}

void ConjugateGradients::clear(double scale) {
  m_unit = 1 / scale;
  std::fill(m_diagonal.begin(), m_diagonal.end(), Block{});
  for (Diagonal& diagonal : m_diagonals) {
    for (Numbers* entries : {&diagonal.blocks.xx, &diagonal.blocks.xy, &diagonal.blocks.yy}) {
      std::fill(entries->begin(), entries->end(), 0.0F);
    }
  }
}

void ConjugateGradients::addPair(int pair, const Block& block) {
  const Slot slot = m_slots[at(pair)];
  Blocks& sums = m_diagonals[at(slot.diagonal)].blocks;
  sums.xx[at(slot.node)] += static_cast<float>(m_unit * block.xx);
  sums.xy[at(slot.node)] += static_cast<float>(m_unit * block.xy);
  sums.yy[at(slot.node)] += static_cast<float>(m_unit * block.yy);
}

bool ConjugateGradients::invertDiagonal() {
  for (int i = 0; i < m_nodes; ++i) {
    const Block& block = m_diagonal[at(i)];
    const double xx = m_unit * block.xx, xy = m_unit * block.xy, yy = m_unit * block.yy;
    const double determinant = xx * yy - xy * xy;
    if (!(xx > 1e-30 && yy > 1e-30 && determinant > 1e-15 * (xx * yy) && xx < 1e15 && yy < 1e15))
      return false;
    const std::size_t k = at(m_margin + i);
    const double inverse = 1 / determinant;
    m_middle.xx[k] = static_cast<float>(xx), m_middle.xy[k] = static_cast<float>(xy);
    m_middle.yy[k] = static_cast<float>(yy);
    m_inverse.xx[k] = static_cast<float>(yy * inverse), m_inverse.xy[k] = static_cast<float>(-xy * inverse);
    m_inverse.yy[k] = static_cast<float>(xx * inverse);
  }
  return true;
}

// Sets m_product = A · m_direction. Returns the scalar product of m_direction and m_product.
double ConjugateGradients::multiply() {
  const float *x = m_direction.x.data(), *y = m_direction.y.data();
  Sum sum;
  for (int i = m_margin; i < m_margin + m_nodes; i += kLanes) {
    const Lanes own_x = load(x + i), own_y = load(y + i), corner = load(&m_middle.xy[at(i)]);
    Lanes to_x = load(&m_middle.xx[at(i)]) * own_x + corner * own_y;
    Lanes to_y = corner * own_x + load(&m_middle.yy[at(i)]) * own_y;
    for (const Diagonal& diagonal : m_diagonals) {
      for (const int from : {i, i - diagonal.distance}) {  // first of the pair: this or the one before
        const int other = from == i ? i + diagonal.distance : from;
        const Lanes other_x = load(x + other), other_y = load(y + other);
        const Lanes side = load(&diagonal.blocks.xy[at(from)]);
        to_x += load(&diagonal.blocks.xx[at(from)]) * other_x + side * other_y;
        to_y += side * other_x + load(&diagonal.blocks.yy[at(from)]) * other_y;
      }
    }
    store(&m_product.x[at(i)], to_x), store(&m_product.y[at(i)], to_y);
    sum.add(own_x * to_x + own_y * to_y);
  }
  return sum.total();
}

// Makes a step along the direction, then sets m_product to the residual times the inverse diagonal blocks.
// Returns the scalar product of the residual and m_product.
double ConjugateGradients::precondition(float step) {
  Sum sum;
  for (int k = m_margin; k < m_margin + m_nodes; k += kLanes) {
    const std::size_t i = at(k);
    store(&m_solution.x[i], load(&m_solution.x[i]) + step * load(&m_direction.x[i]));
    store(&m_solution.y[i], load(&m_solution.y[i]) + step * load(&m_direction.y[i]));
    const Lanes x = load(&m_residual.x[i]) - step * load(&m_product.x[i]);
    const Lanes y = load(&m_residual.y[i]) - step * load(&m_product.y[i]);
    store(&m_residual.x[i], x), store(&m_residual.y[i], y);
    const Lanes corner = load(&m_inverse.xy[i]);
    const Lanes to_x = load(&m_inverse.xx[i]) * x + corner * y;
    const Lanes to_y = corner * x + load(&m_inverse.yy[i]) * y;
    store(&m_product.x[i], to_x), store(&m_product.y[i], to_y);
    sum.add(x * to_x + y * to_y);
  }
  return sum.total();
}

// Sets m_direction = m_product + keep · m_direction.
void ConjugateGradients::turn(float keep) {
  for (int k = m_margin; k < m_margin + m_nodes; k += kLanes) {
    const std::size_t i = at(k);
    store(&m_direction.x[i], load(&m_product.x[i]) + keep * load(&m_direction.x[i]));
    store(&m_direction.y[i], load(&m_product.y[i]) + keep * load(&m_direction.y[i]));
  }
}

// Sets the solution to zero and the residual to `by` times the right-hand side.
void ConjugateGradients::start(std::span<const double> rows, double by) {
  for (Points* points : {&m_solution, &m_direction, &m_product}) {
    std::fill(points->x.begin(), points->x.end(), 0.0F), std::fill(points->y.begin(), points->y.end(), 0.0F);
  }
  for (int i = 0; i < m_nodes; ++i) {
    m_residual.x[at(m_margin + i)] = static_cast<float>(by * rows[at(2 * i)]);
    m_residual.y[at(m_margin + i)] = static_cast<float>(by * rows[at(2 * i + 1)]);
  }
}

int ConjugateGradients::solve(std::span<double> rows, int most, double tolerance) {
  double largest = 0;
  for (const double row : rows) largest = std::max(largest, std::fabs(row));
  if (!invertDiagonal() || !(largest < 1e150)) return -1;
  if (largest == 0) return 0;
  start(rows, 1 / largest);
  double error = precondition(0);
  const double enough = tolerance * tolerance * error;
  turn(0);
  int done = 0;
  while (done < most && error > enough) {
    const double curvature = multiply();
    if (!(curvature > 0)) break;  // a float has no more digits for a better solution
    ++done;
    const double next = precondition(static_cast<float>(error / curvature));
    turn(static_cast<float>(next / error));
    error = next;
  }
  const double back = m_unit * largest;
  for (int i = 0; i < m_nodes; ++i) {
    rows[at(2 * i)] = back * static_cast<double>(m_solution.x[at(m_margin + i)]);
    rows[at(2 * i + 1)] = back * static_cast<double>(m_solution.y[at(m_margin + i)]);
  }
  return done;
}

}  // namespace naiad::physics
