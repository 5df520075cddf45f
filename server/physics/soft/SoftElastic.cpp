#include "physics/soft/SoftElastic.h"

#include <algorithm>
#include <cmath>

#include "physics/soft/SoftForces.h"

namespace naiad::physics {

namespace {

// Part of a radius. An iteration that moves the body by less is close to the solution, so the next iteration
// uses its decomposition again. If that one moves the body by more than kContraction times as much, the
// further iterations of the sub-step compute their own decompositions.
constexpr double kClose = 1e-3;
constexpr double kContraction = 0.1;

// Returns an order of a ring's nodes with a narrow band, in which the two directions alternate.
std::vector<int> folded(int count) {
  std::vector<int> order(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    order[static_cast<std::size_t>(i)] = 2 * i < count ? 2 * i : 2 * (count - 1 - i) + 1;
  }
  return order;
}

int spread(const SoftBody& body, const std::vector<int>& order) {
  int widest = 0;
  const auto see = [&](int a, int b) {
    const int apart = order[static_cast<std::size_t>(a)] - order[static_cast<std::size_t>(b)];
    widest = std::max(widest, apart < 0 ? -apart : apart);
  };
  for (const SoftStretch& s : body.stretches) see(s.a, s.b);
  for (const SoftBend& s : body.bends) {
    see(s.b, s.c);
    if (s.a >= 0) see(s.a, s.b), see(s.a, s.c);
  }
  return widest;
}

// True if the springs have few different distances of node numbers, so gradients are cheap (kMaxDiagonals).
bool isMesh(const SoftBody& body) {
  std::vector<ConjugateGradients::Pair> pairs;
  for (const SoftStretch& s : body.stretches) pairs.push_back({s.a, s.b});
  return ConjugateGradients::diagonalsOf(pairs) <= SoftElastic::kMaxDiagonals;
}

}  // namespace

void SoftElastic::prepare(SoftBody& body) {
  const int count = static_cast<int>(body.nodes.size());
  std::vector<int> plain(at(count));
  for (int i = 0; i < count; ++i) plain[at(i)] = i;
  m_order = folded(count);
  if (spread(body, plain) <= spread(body, m_order)) m_order = plain;
  const int band = 2 * spread(body, m_order) + 1;
  const bool has_gas = body.is_closed && (body.pressure != 0 || body.bulk != 0);
  m_price = static_cast<double>(count) * band * band;
  m_is_wide = !has_gas && body.bends.empty() && m_price > kMaxDirectPrice && isMesh(body);
  if (m_is_wide) m_order = plain;
  m_band.resize(m_is_wide ? 0 : 2 * count, m_is_wide ? 0 : band);
  m_pinned.assign(at(count), 0);
  for (int i = 0; i < count; ++i) m_pinned[at(i)] = body.nodes[at(i)].is_pinned;
  for (auto* rows : {&m_change, &m_gas, &m_gas_response}) rows->assign(at(2 * count), 0);
  m_tensions.assign(body.stretches.size(), 0);
  m_elastic.assign(body.stretches.size(), 0);
  m_hardness.assign(body.stretches.size(), 0);
  m_directions.assign(body.stretches.size(), {});
  for (auto* of_nodes : {&m_base, &m_inertial, &m_start, &m_start_velocity, &m_before, &m_before_velocity}) {
    of_nodes->assign(at(count), {});
  }
  m_history = 0;
  if (m_is_wide) prepareWide(body);
}

void SoftElastic::begin(SoftBody& body, double h, Vec2 gravity, bool is_smooth) {
  const bool has_history = is_smooth && m_history > 0 && h == m_h;
  m_beta = has_history ? 2 * h / 3 : h;
  m_h = h;
  m_gravity = gravity;
  m_is_kept = false;
  m_may_keep = !m_is_wide && m_price > kKeptPrice;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    SoftNode& node = body.nodes[i];
    const Vec2 x = node.offset, v = node.velocity;
    m_start[i] = x, m_start_velocity[i] = v;
    node.offset = x + h * v;
    if (m_pinned[i]) {
      m_base[i] = node.offset - m_beta * v;
      continue;
    }
    m_base[i] = has_history ? x + (x - m_before[i]) / 3 : x;
    const Vec2 speed = has_history ? v + (v - m_before_velocity[i]) / 3 : v;
    m_inertial[i] = m_base[i] + m_beta * speed;
  }
}

void SoftElastic::finish(SoftBody& body) {
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    m_before[i] = m_start[i], m_before_velocity[i] = m_start_velocity[i];
    if (!m_pinned[i]) body.nodes[i].velocity = (body.nodes[i].offset - m_base[i]) / m_beta;
  }
  m_history = 1;
}

void SoftElastic::revert(SoftBody& body) const {
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    body.nodes[i].offset = m_start[i], body.nodes[i].velocity = m_start_velocity[i];
  }
}

void SoftElastic::shift(Vec2 by) {
  for (Vec2& before : m_before) before += by;
}

bool SoftElastic::assemble(const SoftBody& body, bool is_alone) {
  m_is_kept = m_is_kept && is_alone;
  if (m_is_wide) {
    m_gradients.clear(m_scale);
    std::fill(m_change.begin(), m_change.end(), 0);
    addMass(body);
    addStretches(body);
    return true;
  }
  // If rounding has made the matrix singular, retries with slightly more inertia.
  for (const double extra : {0.0, 1e-12, 1e-9, 1e-6}) {
    if (!m_is_kept) m_band.clear();
    std::fill(m_change.begin(), m_change.end(), 0);
    addMass(body);
    addStretches(body);
    addBends(body);
    addPressure(body);
    if (!m_is_kept) {
      for (int i = 0; i < m_band.size(); ++i) m_band.entry(i, i) *= 1 + extra;
      if (!m_band.decompose()) continue;
    }
    if (m_gas_stiffness > 0) {
      m_gas_response = m_gas;
      m_band.solve(m_gas_response.data());
      double product = 0;
      for (std::size_t i = 0; i < m_gas.size(); ++i) product += m_gas[i] * m_gas_response[i];
      m_gas_scale = m_gas_stiffness / (1 + m_gas_stiffness * product);
    }
    respond(m_change.data());
    for (const double c : m_change) {
      if (!(std::fabs(c) < 1e30)) return false;
    }
    return true;
  }
  return false;
}

void SoftElastic::respond(double* rows) const {
  m_band.solve(rows);
  if (m_gas_stiffness == 0) return;
  double product = 0;
  for (std::size_t i = 0; i < m_gas.size(); ++i) product += m_gas[i] * rows[i];
  product *= m_gas_scale;
  for (std::size_t i = 0; i < m_gas.size(); ++i) rows[i] -= product * m_gas_response[i];
}

double SoftElastic::apply(SoftBody& body, std::span<const double> change) {
  double most = 0;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const std::size_t row = at(rowOf(static_cast<int>(i)));
    body.nodes[i].offset += {change[row], change[row + 1]};
    most = std::max({most, std::fabs(change[row]), std::fabs(change[row + 1])});
  }
  for (std::size_t i = 0; i < body.stretches.size(); ++i) {
    const SoftStretch& s = body.stretches[i];
    const std::size_t a = at(rowOf(s.a)), b = at(rowOf(s.b));
    const Vec2 apart = {change[b] - change[a], change[b + 1] - change[a + 1]};
    m_tensions[i] = m_elastic[i] + m_hardness[i] * dot(m_directions[i], apart);
  }
  if (m_is_kept && most > kContraction * m_moved) m_may_keep = false;
  m_is_kept = m_may_keep && most <= kClose * body.radius;
  m_moved = most;
  return most;
}

void SoftElastic::addEntry(int i, int j, double xx, double xy, double yx, double yy) {
  if (m_is_kept || m_pinned[at(i)] || m_pinned[at(j)]) return;
  if (m_is_wide) {
    if (i == j) m_gradients.addDiagonal(i, {xx, xy, yy});
    return;  // the blocks of pairs are set by addLink()
  }
  const int row = rowOf(i), column = rowOf(j);
  if (row < column) return;  // upper half, which the call with i and j exchanged adds
  m_band.entry(row, column) += xx;
  m_band.entry(row + 1, column) += yx;
  m_band.entry(row + 1, column + 1) += yy;
  if (row != column) m_band.entry(row, column + 1) += xy;
}

void SoftElastic::addMass(const SoftBody& body) {
  for (int i = 0; i < static_cast<int>(body.nodes.size()); ++i) {
    const SoftNode& node = body.nodes[at(i)];
    const int row = rowOf(i);
    if (m_pinned[at(i)]) {
      if (m_is_wide) {
        m_gradients.addDiagonal(i, {m_scale, 0, m_scale});
      } else if (!m_is_kept) {
        m_band.entry(row, row) = m_band.entry(row + 1, row + 1) = 1;
      }
      continue;
    }
    const double inertia = node.mass / (m_beta * m_beta), drag = node.mass * body.drag / m_beta;
    addEntry(i, i, inertia + drag, 0, 0, inertia + drag);
    const Vec2 force = inertia * (m_inertial[at(i)] - node.offset) - drag * (node.offset - m_base[at(i)]) +
                       node.mass * m_gravity + node.force;
    m_change[at(row)] += force.x, m_change[at(row + 1)] += force.y;
  }
}

// Adds a spring: its force on a node is −`force` · slope, with the derivative `stiffness` along the slopes.
void SoftElastic::addSpring(const int* nodes, const Vec2* slopes, int count, double force, double stiffness) {
  for (int i = 0; i < count; ++i) {
    if (m_pinned[at(nodes[i])]) continue;
    const std::size_t row = at(rowOf(nodes[i]));
    m_change[row] -= force * slopes[i].x, m_change[row + 1] -= force * slopes[i].y;
    for (int j = 0; j < count && !m_is_kept; ++j) {
      const Vec2 by = stiffness * slopes[i], with = slopes[j];
      addEntry(nodes[i], nodes[j], by.x * with.x, by.x * with.y, by.y * with.x, by.y * with.y);
    }
  }
}

void SoftElastic::addStretches(const SoftBody& body) {
  for (std::size_t i = 0; i < body.stretches.size(); ++i) {
    const SoftStretch& s = body.stretches[i];
    const SoftSpan span = spanOf(body, s);
    const Vec2 along = span.direction;
    const double rate = dot(along, rateOf(body, s.b) - rateOf(body, s.a));
    m_directions[i] = along;
    m_elastic[i] = s.stiffness * (span.length - s.rest_length) + s.damping * rate;
    m_hardness[i] = s.stiffness + s.damping / m_beta;
    const double over = tautBeyond(s, span.length - s.rest_length);
    if (over > 0) m_elastic[i] += kTautSoft * s.stiffness * over, m_hardness[i] += kTautSoft * s.stiffness;
    // A stretched spring also resists turning. A compressed one assists it, which is left to the iteration.
    const double taut = m_tensions[i] / span.length;
    if (m_is_wide) {
      addLink(s, static_cast<int>(i), along, m_elastic[i], m_hardness[i], std::max(0.0, taut));
      continue;
    }
    const int nodes[] = {s.a, s.b};
    const Vec2 slopes[] = {-along, along};
    addSpring(nodes, slopes, 2, m_elastic[i], m_hardness[i]);
    if (m_is_kept || !(taut > 0)) continue;
    const Vec2 side = perpendicular(along);
    const Vec2 turns[] = {-side, side};
    addSpring(nodes, turns, 2, 0, taut);
  }
}

void SoftElastic::addBends(const SoftBody& body) {
  for (const SoftBend& s : body.bends) {
    const SoftCorner corner = cornerOf(body, s);
    const int nodes[] = {s.c, s.b, s.a};
    const int count = s.a < 0 ? 2 : 3;
    double rate = 0;
    for (int k = 0; k < count; ++k) rate += dot(corner.slopes[k], rateOf(body, nodes[k]));
    addSpring(nodes, corner.slopes, count, s.stiffness * corner.bent + s.damping * rate,
              s.stiffness + s.damping / m_beta);
  }
}

void SoftElastic::addPressure(const SoftBody& body) {
  m_gas_stiffness = 0;
  if (!body.is_closed || (body.pressure == 0 && body.bulk == 0)) return;
  std::fill(m_gas.begin(), m_gas.end(), 0);
  const double pressure = pressureOf(body);
  m_gas_stiffness = body.bulk / body.rest_area;
  const int count = static_cast<int>(body.boundary.size());
  for (int i = 0; i < count; ++i) {
    const int node = body.boundary[at(i)];
    if (m_pinned[at(node)]) continue;
    const Vec2 across = body.nodes[at(body.boundary[at(i + 1 < count ? i + 1 : 0)])].offset -
                        body.nodes[at(body.boundary[at(i > 0 ? i - 1 : count - 1)])].offset;
    const Vec2 slope = {0.5 * across.y, -0.5 * across.x};
    const std::size_t row = at(rowOf(node));
    m_gas[row] += slope.x, m_gas[row + 1] += slope.y;
    m_change[row] += pressure * slope.x, m_change[row + 1] += pressure * slope.y;
  }
}

}  // namespace naiad::physics
