#include "engine/world/PathFind.h"

#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"

namespace df {

namespace {

constexpr std::size_t kMaxCells = 20'000;
// Lengths of a step in units of 1/5 cell, as integers: 5 along an axis, 7 (about 5√2) diagonally.
constexpr int kStraight = 5;
constexpr int kDiagonal = 7;

using Node = std::pair<int, int>;  // steps from the start, to the right and down

struct Visit {
  int length = 0;
  Node from;
};

class Search {
 public:
  Search(const Object& object, Vector end)
      : m_object(object),
        m_world(*object.getWorld()),
        m_start(object.getPosition()),
        m_goal(static_cast<int>(std::lrint(end.x() - m_start.x())),
               static_cast<int>(std::lrint(end.y() - m_start.y()))) {}

  bool run() {
    m_visits[{0, 0}] = {};
    m_open.emplace(estimate({0, 0}), 0, Node{0, 0});
    while (!m_open.empty() && m_visits.size() < kMaxCells) {
      const auto [total, length, node] = m_open.top();
      m_open.pop();
      if (node == m_goal) return true;
      if (m_visits[node].length == length) expand(node, length);
    }
    return false;
  }

  std::vector<Vector> nodes(Vector end) const {
    std::vector<Vector> nodes{end};
    for (Node node = m_goal; node != Node{0, 0};) {
      node = m_visits.at(node).from;
      if (node != Node{0, 0}) nodes.insert(nodes.begin(), positionOf(node));
    }
    return nodes;
  }

 private:
  Vector positionOf(Node node) const { return m_start + Vector(node.first, node.second); }

  int estimate(Node node) const {
    const int x = std::abs(node.first - m_goal.first);
    const int y = std::abs(node.second - m_goal.second);
    return kDiagonal * std::min(x, y) + kStraight * (std::max(x, y) - std::min(x, y));
  }

  bool isFree(Node node) const {
    if (node == m_goal) return true;
    const Vector place = positionOf(node);
    const Box boundary = fromFixed(m_world.views().boundary());
    const Vector inside = place - boundary.getCorner();
    if (inside.x() < 0 || inside.y() < 0 || inside.x() >= boundary.width() || inside.y() >= boundary.height())
      return false;
    const ObjectList others = m_world.objects().getCollisions(&m_object, place);
    for (int i = 0; i < others.getCount(); ++i) {
      if (others[i] != nullptr && others[i]->getSolidness() == HARD) return false;
    }
    return true;
  }

  void expand(Node node, int length) {
    static constexpr std::array<Node, 8> kSteps{
        {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
    for (const Node& step : kSteps) {
      const Node next{node.first + step.first, node.second + step.second};
      const bool diagonal = step.first != 0 && step.second != 0;
      const int longer = length + (diagonal ? kDiagonal : kStraight);
      const auto known = m_visits.find(next);
      if (known != m_visits.end() ? known->second.length <= longer : !isFree(next)) continue;
      // A diagonal step must not cut a corner.
      if (diagonal && !(isFree({next.first, node.second}) && isFree({node.first, next.second}))) continue;
      m_visits[next] = {longer, node};
      m_open.emplace(longer + estimate(next), longer, next);
    }
  }

  const Object& m_object;
  World& m_world;
  Vector m_start;
  Node m_goal;
  std::map<Node, Visit> m_visits;
  using Open = std::tuple<int, int, Node>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> m_open;
};

}  // namespace

Path findPath(const Object& object, Vector end) {
  Path path;
  constexpr double kFar = 10'000;
  const Vector displacement = end - object.getPosition();
  if (object.getWorld() == nullptr ||
      !(std::fabs(displacement.x()) < kFar && std::fabs(displacement.y()) < kFar))
    return path;
  Search search(object, end);
  if (search.run()) path.setPath(search.nodes(end));
  return path;
}

}  // namespace df
