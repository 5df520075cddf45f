// Solves the systems of a wide body by conjugate gradients (SoftElastic.h).
#include <algorithm>
#include <cmath>

#include "physics/soft/SoftElastic.h"

namespace naiad::physics {

namespace {

/// Limit of a spring's stiffness divided by the lighter node's mass, per tick². With four sub-steps it is 3e4
/// times the resistance of the mass itself, and floats still resolve both to some digits.
constexpr double kStiffest = 1e6;
/// Limit of iterations in one solution; a sub-step has two solutions (SoftWideStep.cpp).
constexpr int kMaxGradients = 64;
constexpr double kGradientTolerance = 1e-3;  // part of the initial error that may remain

}  // namespace

void SoftElastic::prepareWide(SoftBody& body) {
  double heaviest = 0, stiffest = 0;
  for (const SoftNode& node : body.nodes) heaviest = std::max(heaviest, node.mass);
  std::vector<ConjugateGradients::Pair> pairs;
  for (SoftStretch& s : body.stretches) {
    const double most = kStiffest * std::min(body.nodes[at(s.a)].mass, body.nodes[at(s.b)].mass);
    if (s.stiffness >= most) s.stiffness = most, s.limit = 0;
    stiffest = std::max(stiffest, s.stiffness);
    pairs.push_back({s.a, s.b});
  }
  m_gradients.resize(static_cast<int>(body.nodes.size()), pairs);
  m_scale = heaviest + stiffest;
}

void SoftElastic::addLink(const SoftStretch& s, int pair, Vec2 along, double force, double stiffness,
                          double taut) {
  const Vec2 pull = force * along, more = (stiffness - taut) * along;
  const ConjugateGradients::Block block = {taut + more.x * along.x, more.x * along.y,
                                           taut + more.y * along.y};
  const std::size_t a = at(rowOf(s.a)), b = at(rowOf(s.b));
  if (!m_pinned[at(s.a)]) {
    m_change[a] += pull.x, m_change[a + 1] += pull.y;
    m_gradients.addDiagonal(s.a, block);
  }
  if (!m_pinned[at(s.b)]) {
    m_change[b] -= pull.x, m_change[b + 1] -= pull.y;
    m_gradients.addDiagonal(s.b, block);
  }
  const double free = m_pinned[at(s.a)] || m_pinned[at(s.b)] ? 0 : -1;
  m_gradients.addPair(pair, {free * block.xx, free * block.xy, free * block.yy});
}

void SoftElastic::addPush(int node, Vec2 axis, double force, double stiffness) {
  if (m_pinned[at(node)]) return;
  const std::size_t row = at(rowOf(node));
  m_change[row] += force * axis.x, m_change[row + 1] += force * axis.y;
  m_gradients.addDiagonal(
      node, {stiffness * axis.x * axis.x, stiffness * axis.x * axis.y, stiffness * axis.y * axis.y});
}

bool SoftElastic::solveWide(const SoftBody& body, bool is_free, bool& is_settled) {
  Vec2 push;
  for (std::size_t i = 0; i < m_change.size(); i += 2) push += {m_change[i], m_change[i + 1]};
  const int steps = m_gradients.solve(m_change, kMaxGradients, kGradientTolerance);
  is_settled = steps < kMaxGradients;
  // The springs' forces cancel in the sum of all forces. The remaining sum must move the body as a whole.
  double inertia = 0;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    const double own = body.nodes[i].mass * (1 + body.drag * m_beta) / (m_beta * m_beta);
    inertia += own;
    push -= own * Vec2{m_change[2 * i], m_change[2 * i + 1]};
    is_free = is_free && !m_pinned[i];
  }
  for (std::size_t i = 0; i < m_change.size(); ++i) {
    if (is_free) m_change[i] += (i % 2 == 0 ? push.x : push.y) / inertia;
    if (!(std::fabs(m_change[i]) < 1e30)) return false;
  }
  return steps >= 0;
}

}  // namespace naiad::physics
