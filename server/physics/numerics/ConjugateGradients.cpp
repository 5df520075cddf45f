#include "physics/numerics/ConjugateGradients.h"

#include <algorithm>
#include <cmath>

namespace naiad::physics {

void ConjugateGradients::resize(int nodes, std::span<const Pair> pairs) {
  m_begins.assign(at(nodes) + 1, 0);
  for (const Pair& pair : pairs) ++m_begins[at(pair.a) + 1], ++m_begins[at(pair.b) + 1];
  for (std::size_t i = 1; i < m_begins.size(); ++i) m_begins[i] += m_begins[i - 1];
  m_neighbours.resize(2 * pairs.size());
  m_blocks.assign(2 * pairs.size(), Lanes{});
  m_slots.clear();
  std::vector<int> next(m_begins.begin(), m_begins.end() - 1);
  for (const Pair& pair : pairs) {
    const Pair slot = {next[at(pair.a)]++, next[at(pair.b)]++};
    m_neighbours[at(slot.a)] = pair.b, m_neighbours[at(slot.b)] = pair.a;
    m_slots.push_back(slot);
  }
  m_diagonal.assign(at(nodes), {});
  forgetSolution();
  m_middle.assign(at(nodes), Lanes{}), m_inverse.assign(at(nodes), Lanes{});
  for (auto* points : {&m_solution, &m_residual, &m_direction, &m_product, &m_preconditioned}) {
    points->assign(at(nodes), {});
  }
}

void ConjugateGradients::clear(double scale) {
  m_unit = 1 / scale;
  std::fill(m_diagonal.begin(), m_diagonal.end(), Block{});
}

void ConjugateGradients::setPair(int pair, const Block& block) {
  const auto xy = static_cast<float>(m_unit * block.xy);
  const Lanes lanes = {static_cast<float>(m_unit * block.xx), xy, xy, static_cast<float>(m_unit * block.yy)};
  m_blocks[at(m_slots[at(pair)].a)] = m_blocks[at(m_slots[at(pair)].b)] = lanes;
}

bool ConjugateGradients::invertDiagonal() {
  for (std::size_t i = 0; i < m_diagonal.size(); ++i) {
    const double xx = m_unit * m_diagonal[i].xx, xy = m_unit * m_diagonal[i].xy,
                 yy = m_unit * m_diagonal[i].yy, determinant = xx * yy - xy * xy;
    if (!(xx > 1e-30 && yy > 1e-30 && determinant > 1e-15 * (xx * yy) && xx < 1e15 && yy < 1e15))
      return false;
    const auto side = static_cast<float>(-xy / determinant), corner = static_cast<float>(xy);
    m_middle[i] = Lanes{static_cast<float>(xx), corner, corner, static_cast<float>(yy)};
    m_inverse[i] =
        Lanes{static_cast<float>(yy / determinant), side, side, static_cast<float>(xx / determinant)};
  }
  return true;
}

double ConjugateGradients::multiply() {
  double product = 0;
  for (std::size_t i = 0; i < m_middle.size(); ++i) {
    const Point own = m_direction[i];
    Lanes sum = m_middle[i] * Lanes{own.x, own.x, own.y, own.y};
    for (int k = m_begins[i]; k < m_begins[i + 1]; ++k) {
      const Point other = m_direction[at(m_neighbours[at(k)])];
      sum += m_blocks[at(k)] * Lanes{other.x, other.x, other.y, other.y};
    }
    const Point result = {sum[0] + sum[2], sum[1] + sum[3]};
    m_product[i] = result;
    product += static_cast<double>(own.x * result.x + own.y * result.y);
  }
  return product;
}

void ConjugateGradients::precondition() {
  for (std::size_t i = 0; i < m_inverse.size(); ++i) {
    const Point r = m_residual[i];
    const Lanes sum = m_inverse[i] * Lanes{r.x, r.x, r.y, r.y};
    m_preconditioned[i] = {sum[0] + sum[2], sum[1] + sum[3]};
  }
}

// The last solution, if what is minimised, x·Ax / 2 − b·x, is less there than at zero.
void ConjugateGradients::startFromLast(double unit) {
  const double ratio = m_solution_unit / unit;
  if (!(ratio > 0 && ratio < 1e6)) return std::fill(m_solution.begin(), m_solution.end(), Point{0, 0});
  const auto by = static_cast<float>(ratio);
  double gain = 0;
  for (std::size_t i = 0; i < m_solution.size(); ++i) {
    m_direction[i] = {by * m_solution[i].x, by * m_solution[i].y};
    gain += static_cast<double>(m_direction[i].x * m_residual[i].x + m_direction[i].y * m_residual[i].y);
  }
  const double curvature = multiply();
  if (!(0.5 * curvature < gain)) return std::fill(m_solution.begin(), m_solution.end(), Point{0, 0});
  m_solution.swap(m_direction);
  for (std::size_t i = 0; i < m_residual.size(); ++i) {
    m_residual[i].x -= m_product[i].x, m_residual[i].y -= m_product[i].y;
  }
  precondition();
}

int ConjugateGradients::solve(double* rows, int most, double tolerance) {
  const std::size_t nodes = m_diagonal.size();
  double largest = 0;
  for (std::size_t i = 0; i < 2 * nodes; ++i) largest = std::max(largest, std::fabs(rows[i]));
  if (!invertDiagonal() || !(largest < 1e150)) return -1;
  if (largest == 0) return forgetSolution(), 0;
  const double by = 1 / largest;
  const auto dot = [nodes](const std::vector<Point>& a, const std::vector<Point>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < nodes; ++i) sum += static_cast<double>(a[i].x * b[i].x + a[i].y * b[i].y);
    return sum;
  };
  for (std::size_t i = 0; i < nodes; ++i) {
    m_residual[i] = {static_cast<float>(by * rows[2 * i]), static_cast<float>(by * rows[2 * i + 1])};
  }
  precondition();
  const double enough = tolerance * tolerance * dot(m_residual, m_preconditioned);
  startFromLast(m_unit * largest);
  m_direction = m_preconditioned;
  double error = dot(m_residual, m_preconditioned);
  int done = 0;
  while (done < most && error > enough) {
    const double curvature = multiply();
    if (!(curvature > 0)) break;  // the digits of a float are used up
    ++done;
    const auto step = static_cast<float>(error / curvature);
    for (std::size_t i = 0; i < nodes; ++i) {
      m_solution[i].x += step * m_direction[i].x, m_solution[i].y += step * m_direction[i].y;
      m_residual[i].x -= step * m_product[i].x, m_residual[i].y -= step * m_product[i].y;
    }
    precondition();
    const double next = dot(m_residual, m_preconditioned);
    const auto keep = static_cast<float>(next / error);
    error = next;
    for (std::size_t i = 0; i < nodes; ++i) {
      m_direction[i] = {m_preconditioned[i].x + keep * m_direction[i].x,
                        m_preconditioned[i].y + keep * m_direction[i].y};
    }
  }
  const double back = m_solution_unit = m_unit * largest;
  for (std::size_t i = 0; i < nodes; ++i) {
    rows[2 * i] = back * static_cast<double>(m_solution[i].x);
    rows[2 * i + 1] = back * static_cast<double>(m_solution[i].y);
  }
  return done;
}

}  // namespace naiad::physics
