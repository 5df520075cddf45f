#include "physics/soft/SoftBody.h"

#include <cmath>

#include "physics/soft/SoftForces.h"

namespace naiad::physics {

namespace {

bool isLoad(double x) {
  return x >= 0 && isSmallSoft(x);
}

}  // namespace

bool isValid(const SoftBody& body) {
  const int count = static_cast<int>(body.nodes.size());
  if (count < 1 || count > kMaxSoftNodes || body.boundary.size() > body.nodes.size()) return false;
  const auto isNode = [count](int i) { return i >= 0 && i < count; };
  bool is_sound = std::fabs(body.place.dx) <= 1 && std::fabs(body.place.dy) <= 1 && body.radius >= 1e-6 &&
                  isSmallSoft(body.radius) && isLoad(body.friction) && isLoad(body.drag) &&
                  isSmallSoft(body.pressure) && isLoad(body.bulk);
  for (const SoftNode& node : body.nodes) {
    is_sound = is_sound && isSmallSoft(node.offset) && isSmallSoft(node.velocity) &&
               isSmallSoft(node.force) && node.mass >= 1e-12 && isSmallSoft(node.mass);
  }
  for (const SoftStretch& s : body.stretches) {
    is_sound = is_sound && isNode(s.a) && isNode(s.b) && s.a != s.b && s.rest_length >= 1e-9 &&
               isSmallSoft(s.rest_length) && isLoad(s.stiffness) && isLoad(s.damping) && isLoad(s.limit);
  }
  for (const SoftBend& s : body.bends) {
    const bool is_clamp = s.a == -1;
    is_sound = is_sound && isNode(s.b) && isNode(s.c) && s.b != s.c && (is_clamp || isNode(s.a)) &&
               s.a != s.b && s.a != s.c && std::fabs(s.rest_angle) <= 3.2 && isLoad(s.stiffness) &&
               isLoad(s.damping) && isSmallSoft(s.direction) &&
               (!is_clamp || lengthSquared(s.direction) > 1e-12);
  }
  for (const int node : body.boundary) is_sound = is_sound && isNode(node);
  if (body.is_closed && body.boundary.size() < 3) return false;
  const bool has_gas = body.pressure != 0 || body.bulk != 0;
  return is_sound && (!has_gas || (body.is_closed && body.rest_area >= 1e-9 && isSmallSoft(body.rest_area)));
}

double energyOf(const SoftBody& body, Vec2 gravity) {
  double energy = 0;
  for (const SoftNode& node : body.nodes) {
    if (node.is_pinned) continue;
    energy += node.mass * (0.5 * lengthSquared(node.velocity) - dot(gravity, node.offset)) -
              dot(node.force, node.offset);
  }
  for (const SoftStretch& s : body.stretches) {
    const double longer = spanOf(body, s).length - s.rest_length;
    energy += 0.5 * s.stiffness * longer * longer;
    const double over = tautBeyond(s, longer);
    if (over > 0) energy += 0.5 * kTautSoft * s.stiffness * over * over;
  }
  for (const SoftBend& s : body.bends) {
    const double bent = cornerOf(body, s).bent;
    energy += 0.5 * s.stiffness * bent * bent;
  }
  if (!body.is_closed || (body.pressure == 0 && body.bulk == 0)) return energy;
  const double area = areaOf(body), grown = area / body.rest_area - 1;
  return energy - body.pressure * area + 0.5 * body.bulk * body.rest_area * grown * grown;
}

}  // namespace naiad::physics
