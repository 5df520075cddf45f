#include "physics/joint/JointChain.h"

#include <algorithm>
#include <cmath>

#include "physics/joint/JointMethod.h"

namespace naiad::physics {

namespace {

constexpr double kCertain = 0.02;  // part of the tolerance: smaller predicted residuals are not computed
constexpr double kBad = 1e-3;      // part of the diagonal: smaller pivots would lose too many digits

}  // namespace

void JointChain::connect(std::span<const Rod> rods, std::span<const JointMass> masses) {
  m_nodes.clear();
  m_rods.clear();
  const auto sharesNext = [&](std::size_t i, int body) {
    return i + 1 < rods.size() && (rods[i + 1].a == body || rods[i + 1].b == body) &&
           masses[static_cast<std::size_t>(body)].inverse_mass > 0;
  };
  const auto addNode = [&](int body) {
    Node node = {};
    node.body = body;
    node.inverse_mass = masses[static_cast<std::size_t>(body)].inverse_mass;
    m_nodes.push_back(node);
  };
  for (std::size_t i = 0; i < rods.size(); ++i) {
    const Rod& rod = rods[i];
    const bool is_backward = i == 0 ? sharesNext(0, rod.a) : rod.b == m_nodes.back().body;
    if (i == 0) addNode(is_backward ? rod.b : rod.a);
    addNode(is_backward ? rod.a : rod.b);
    Link link = {};
    link.square = rod.square;
    link.half_inverse_length = rod.half_inverse_length;
    link.is_backward = is_backward;
    m_rods.push_back(link);
  }
}

void JointChain::load(std::span<const Vec2> place, std::span<const Vec2> velocity,
                      std::span<const Vec2> acceleration, std::span<const double> multiplier,
                      double tolerance) {
  for (Node& node : m_nodes) {
    const auto body = static_cast<std::size_t>(node.body);
    node.place = Pair{place[body].x, place[body].y};
    node.velocity = Pair{velocity[body].x, velocity[body].y};
    node.acceleration = Pair{acceleration[body].x, acceleration[body].y};
  }
  for (std::size_t i = 0; i < m_rods.size(); ++i) {
    m_rods[i].multiplier = multiplier[i];
    m_rods[i].force = Pair{};
  }
  m_tolerance = tolerance;
  m_last_h = 0;
}

void JointChain::store(std::span<Vec2> place, std::span<Vec2> velocity, std::span<double> multiplier,
                       std::span<Vec2> force, std::span<const int> index_of) const {
  for (const Node& node : m_nodes) {
    const auto body = static_cast<std::size_t>(node.body);
    place[body] = {node.place[0], node.place[1]};
    velocity[body] = {node.velocity[0], node.velocity[1]};
  }
  for (std::size_t i = 0; i < m_rods.size(); ++i) {
    const double sign = m_rods[i].is_backward ? -1 : 1;
    multiplier[i] = m_rods[i].multiplier;
    force[static_cast<std::size_t>(index_of[i])] = {sign * m_rods[i].force[0], sign * m_rods[i].force[1]};
  }
}

// Moves the nodes by h, kicks them by `half`, and projects their velocities onto those that the rods allow.
// Keeps the factors for the next stage.
JointChain::Status JointChain::finish(double h, double half) {
  Node* node = m_nodes.data();
  Pair place = node->before + h * node->velocity;
  node->place = place;
  node->velocity += half * node->acceleration;
  Pair last_direction = {};
  double last_lower = 0, last_rest = 0, last_inverse = 0;
  bool is_good = true;
  for (Link& rod : m_rods) {
    const double mass = node->inverse_mass;
    const Pair velocity = node->velocity;
    ++node;
    node->place = node->before + h * node->velocity;
    node->velocity += half * node->acceleration;
    const Pair direction = (2 * rod.half_inverse_length) * (node->place - place);
    place = node->place;
    const double beside = -mass * dot(last_direction, direction);  // with the rod before; 0 for the first one
    last_lower = beside * last_inverse;
    if (&rod != m_rods.data()) (&rod - 1)->lower = last_lower;
    const double diagonal = (mass + node->inverse_mass) * dot(direction, direction);
    const double pivot = diagonal - last_lower * beside;
    is_good &= pivot > kBad * diagonal;
    last_inverse = 1 / pivot;
    last_rest = -dot(direction, node->velocity - velocity) - last_lower * last_rest;
    rod.direction = last_direction = direction;
    rod.inverse = last_inverse;
    rod.rest = last_rest;
  }
  if (!is_good) return Status::kBad;
  double next = 0;
  for (std::size_t i = m_rods.size(); i-- > 0;) {
    Link& rod = m_rods[i];
    next = i + 1 == m_rods.size() ? rod.rest * rod.inverse : rod.rest * rod.inverse - rod.lower * next;
    rod.force += next * rod.direction;
    push(&m_nodes[i], rod, next);
  }
  return Status::kDone;
}

JointChain::Status JointChain::project() {
  for (Node& node : m_nodes) node.before = node.place;
  return finish(0, 0);
}

// Simplified Newton iteration, like JointIsland::iterateNewton().
bool JointChain::iterateNewton(double h, std::uint64_t& iterations) {
  const double to_impulse = -1 / h;
  double last = 0;
  for (int iteration = 0; iteration < newton::kMaxIterations; ++iteration) {
    double worst = 0, sum = 0, rest = 0;
    const Node* node = m_nodes.data();
    Pair place = node->before + h * node->velocity;
    double lower = 0;
    for (Link& rod : m_rods) {
      ++node;
      const Pair next = node->before + h * node->velocity, offset = next - place;
      place = next;
      const double value = (dot(offset, offset) - rod.square) * rod.half_inverse_length;
      worst = std::max(worst, std::abs(value));
      sum += std::abs(value);
      rest = value * to_impulse - lower * rest;
      lower = rod.lower;
      rod.rest = rest;
    }
    if (!(sum <= 1e30)) return false;
    if (worst <= m_tolerance) return true;
    if (iteration >= newton::kFree && worst > newton::kSlow * last) return worst <= 20 * m_tolerance;
    ++iterations;
    rest = 0;
    for (std::size_t i = m_rods.size(); i-- > 0;) {
      Link& rod = m_rods[i];
      rest = i + 1 == m_rods.size() ? rod.rest * rod.inverse : rod.rest * rod.inverse - rod.lower * rest;
      rod.multiplier += rest;
      push(&m_nodes[i], rod, rest);
    }
    if (iteration > 0 && worst * worst <= kCertain * m_tolerance * last) return true;
    last = worst;
  }
  return false;
}

JointChain::Status JointChain::stage(double h, std::uint64_t& iterations) {
  const double half = 0.5 * h;
  for (Node& node : m_nodes) {
    node.before = node.place;
    node.velocity += half * node.acceleration;
  }
  const bool is_again = h == m_last_h;
  for (std::size_t i = 0; i < m_rods.size(); ++i) {
    Link& rod = m_rods[i];
    const double rate = rod.multiplier;
    const double guess = is_again ? 2 * rate - rod.last_multiplier : rate;
    rod.last_multiplier = rate;
    rod.multiplier = guess * h;
    push(&m_nodes[i], rod, rod.multiplier);
  }
  m_last_h = h;
  if (!iterateNewton(h, iterations)) return Status::kSlow;
  const double per_h = 1 / h;
  for (Link& rod : m_rods) {
    rod.force += rod.multiplier * rod.direction;
    rod.multiplier *= per_h;
  }
  return finish(h, half);
}

}  // namespace naiad::physics
