// Records a LiveScene.
#include <algorithm>
#include <cmath>
#include <limits>

#include "LiveScene.h"
#include "physics/geometry/Rotation.h"

namespace hunt {
namespace {

using naiad::physics::inverse;
using naiad::physics::rotationBy;

// Above this square of an oscillation's rate, per tick², the energy of a spring is not followed.
constexpr double kStiff = .5;

// Returns the integral of tanh(c x) from 0 to x.
double tanhPotential(double c, double x) {
  const double u = std::abs(c * x);
  return (u + std::log1p(std::exp(-2 * u)) - std::log(2.0)) / c;
}

// Returns the potential of a force that grows with k x up to a limit.
double limitedPotential(double k, double x, double limit) {
  const double u = std::abs(x);
  return k * u <= limit ? .5 * k * u * u : limit * u - .5 * limit * limit / k;
}

}  // namespace

void LiveScene::recordTick() {
  Tick tick;
  tick.acted = m_acted;
  tick.displaced = m_displaced;
  for (const HuntBody* p_body : m_bodies) {
    BodyState state;
    if (p_body != nullptr) {
      state = {metric(p_body->getPosition()),
               metric(p_body->getVelocity()),
               p_body->getAngle(),
               p_body->getSpin(),
               true,
               p_body->isFrozen()};
    }
    tick.bodies.push_back(state);
  }
  if (m_detail == Detail::ALL) {
    m_recording.ticks.push_back(tick);
    Tick& its = m_recording.ticks.back();
    its.sums = sums();
    recordSolids(its);
    recordOpenings(its);
    recordContacts(its);
  } else {
    m_recording.ticks.push_back(std::move(tick));
  }
}

Sums LiveScene::sums() const {
  Sums sums;
  double mass = 0;
  Vec2 middle;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    const BodyData& data = m_now.bodies[i];
    if (m_bodies[i] == nullptr || data.kinematic || data.group != 0) continue;
    mass += data.mass;
    middle += data.mass * metric(m_bodies[i]->getPosition());
    sums.momentum += data.mass * metric(m_bodies[i]->getVelocity());
    sums.force += data.mass * data.gravity_scale * m_now.gravity;
    addPotential(i, sums);
  }
  if (mass == 0) return sums;
  middle = middle / mass;
  const Vec2 drift = sums.momentum / mass;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    const BodyData& data = m_now.bodies[i];
    if (m_bodies[i] == nullptr || data.kinematic || data.group != 0) continue;
    const Vec2 v = metric(m_bodies[i]->getVelocity());
    const double turning = m_bodies[i]->isTurning() ? m_bodies[i]->getInertia() * m_bodies[i]->getSpin() : 0;
    sums.kinetic += .5 * (data.mass * dot(v, v) + turning * m_bodies[i]->getSpin());
    sums.momentum_scale += data.mass * length(v);
    const Vec2 from = metric(m_bodies[i]->getPosition()) - middle;
    sums.angular += turning + data.mass * cross(from, v - drift);
    sums.angular_scale += std::abs(turning) + data.mass * length(from) * length(v - drift);
  }
  for (std::size_t i = 0; i < m_joints.size(); ++i) addJointPotential(i, sums);
  return sums;
}

void LiveScene::addPotential(std::size_t index, Sums& sums) const {
  const BodyData& data = m_now.bodies[index];
  const Vec2 place = metric(m_bodies[index]->getPosition());
  const Vec2 weight = data.mass * data.gravity_scale * m_now.gravity;
  sums.potential -= dot(weight, place);
  sums.pull += length(weight);
  sums.rest += .5 * dot(weight, weight) / (16 * data.mass);
  if (data.stiffness > 0) {
    const Vec2 d = place - data.anchor;
    (data.stiffness > kStiff ? sums.stiff : sums.potential) += .5 * data.mass * data.stiffness * dot(d, d);
    sums.pull += data.mass * data.stiffness * length(d);
  }
  if (data.field == kNothing) return;
  const FieldData& field = m_now.fields[static_cast<std::size_t>(data.field)];
  const Vec2 d = place - data.field_origin;
  if (field.kind == FieldData::Kind::LINEAR) {
    (field.strength > kStiff ? sums.stiff : sums.potential) += .5 * data.mass * field.strength * dot(d, d);
    sums.pull += data.mass * field.strength * length(d);
  } else if (field.kind == FieldData::Kind::TANH) {
    (field.strength * field.steepness > kStiff ? sums.stiff : sums.potential) +=
        data.mass * field.strength *
        (tanhPotential(field.steepness, d.x) + tanhPotential(field.steepness, d.y));
    sums.pull += 2 * data.mass * field.strength;
  }
}

void LiveScene::addJointPotential(std::size_t index, Sums& sums) const {
  const JointData& data = m_now.joints[index];
  if (!m_joints[index].exists() || m_now.groupOf(data) != 0) return;
  if (data.kind == JointData::Kind::SPRING) {
    const double rest = data.length > 0 ? data.length : length(data.point_b - data.point_a);
    const double stretch = length(anchorOf(data, true) - anchorOf(data, false)) - rest;
    double lightest = std::numeric_limits<double>::infinity();
    for (const int end : {data.a, data.b}) {
      if (end != kNothing) lightest = std::min(lightest, m_now.bodies[static_cast<std::size_t>(end)].mass);
    }
    (data.first > kStiff * lightest ? sums.stiff : sums.potential) += .5 * data.first * stretch * stretch;
    sums.pull += data.first * std::abs(stretch);
  } else if (data.kind == JointData::Kind::MOUSE) {
    const Vec2 d = anchorOf(data, true) - (data.has_target ? data.target : data.point_b);
    sums.potential +=
        limitedPotential(data.second, d.x, data.first) + limitedPotential(data.second, d.y, data.first);
    sums.pull += std::min(data.second * length(d), 2 * data.first);
  }
}

// Returns where the end of a joint is now.
Vec2 LiveScene::anchorOf(const JointData& joint, bool second) const {
  const int index = second ? joint.b : joint.a;
  const Vec2 point = second ? joint.point_b : joint.point_a;
  if (index == kNothing) return point;
  const HuntBody& body = *bodyAt(index);
  const BodyData& start = m_now.bodies[static_cast<std::size_t>(index)];
  return metric(body.getPosition()) +
         rotationBy(body.getAngle()) * (inverse(rotationBy(start.angle)) * (point - start.place));
}

Solid LiveScene::solidOf(std::size_t index) const {
  const HuntBody& body = *m_bodies[index];
  Solid solid;
  solid.centre = metric(body.getPosition());
  const auto rotation = rotationBy(body.getAngle());
  for (const naiad::physics::ConvexShape& shape : body.getShapes()) {
    SolidPart part;
    part.radius = shape.radius;
    for (int i = 0; i < shape.count; ++i)
      part.points.push_back(solid.centre + rotation * shape.vertices[static_cast<std::size_t>(i)]);
    solid.parts.push_back(std::move(part));
  }
  if (solid.parts.empty()) {  // the Object's box, which does not turn
    const df::Box box = body.getBox();
    const Vec2 lower = solid.centre + metric(box.getCorner());
    const Vec2 upper = lower + metric({box.width(), box.height()});
    solid.parts = {{{lower, {upper.x, lower.y}, upper, {lower.x, upper.y}}, 0}};
  }
  measure(solid);
  return solid;
}

Solid LiveScene::solidOf(const ObstacleData& obstacle) const {
  const Vec2 c = obstacle.centre, h = obstacle.half;
  Solid solid;
  solid.centre = c;
  solid.parts = {{{c - h, {c.x + h.x, c.y - h.y}, c + h, {c.x - h.x, c.y + h.y}}, 0}};
  measure(solid);
  return solid;
}

bool LiveScene::areJoined(int a, int b) const {
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    const JointData& data = m_now.joints[i];
    if (((data.a == a && data.b == b) || (data.a == b && data.b == a)) && m_joints[i].exists()) return true;
  }
  return false;
}

void LiveScene::recordSolids(Tick& tick) {
  const std::vector<Tick>& ticks = m_recording.ticks;
  const std::vector<BodyState>& before = ticks.size() > 1 ? ticks[ticks.size() - 2].bodies : tick.bodies;
  for (std::size_t i = 0; i < m_bodies.size(); ++i) {
    m_body_solids[i] = m_bodies[i] != nullptr ? solidOf(i) : Solid{};
    const BodyState &from = before[i], &to = tick.bodies[i];
    m_travels[i] = length(to.place - from.place) + length(from.velocity) + length(to.velocity) +
                   m_body_solids[i].reach * std::max(std::abs(from.spin), std::abs(to.spin));
  }
  for (std::size_t i = 0; i < m_obstacles.size(); ++i) {
    if (m_acted || ticks.size() == 1)
      m_obstacle_solids[i] = m_obstacles[i] != nullptr ? solidOf(m_now.obstacles[i]) : Solid{};
  }
  for (int i = 0; i < static_cast<int>(m_bodies.size()); ++i) {
    for (int j = i + 1; j < static_cast<int>(m_bodies.size()); ++j) recordPair(tick, i, j);
    for (int j = 0; j < static_cast<int>(m_obstacles.size()); ++j) recordPair(tick, i, obstacleNumber(j));
  }
}

void LiveScene::recordPair(Tick& tick, int a, int b) {
  const Solid *p_a = solidAt(a), *p_b = solidAt(b);
  if (p_a == nullptr || p_b == nullptr || solidnessOf(a) != df::HARD || solidnessOf(b) != df::HARD) return;
  const bool is_dynamic = m_now.bodies[static_cast<std::size_t>(a)].isDynamic();
  const bool is_other = b >= 0 && m_now.bodies[static_cast<std::size_t>(b)].isDynamic();
  if (!is_dynamic && !is_other) return;
  const double depth = depthOf(*p_a, *p_b);
  const auto found = std::find(m_excluded.begin(), m_excluded.end(), std::pair(a, b));
  if (depth <= 0 && found != m_excluded.end()) m_excluded.erase(found);
  if (depth <= 0 || found != m_excluded.end()) return;
  if ((m_displaces || m_recording.ticks.size() == 1) && depth > 1e-9) {
    m_excluded.emplace_back(a, b);
    if (!areJoined(a, b)) tick.displaced = m_displaced = true;
    return;
  }
  if (areJoined(a, b)) return;
  // Bodies that move fast overlap between a step's search and the next.
  const double travel = travelOf(a) + travelOf(b);
  const double unavoidable = (m_now.level == df::ACCURACY_FAST ? .25 : .05) * travel;
  const double thickness =
      std::min(is_dynamic ? p_a->thickness : p_b->thickness, is_other ? p_b->thickness : p_a->thickness);
  tick.depth = std::max(tick.depth, (depth - unavoidable) / thickness);
  tick.shift += depth;
}

void LiveScene::recordOpenings(Tick& tick) const {
  for (std::size_t i = 0; i < m_joints.size(); ++i) {
    const JointData& data = m_now.joints[i];
    using Kind = JointData::Kind;
    const bool has_length = data.kind == Kind::DISTANCE || data.kind == Kind::ROPE;
    const bool has_point = data.kind == Kind::HINGE || data.kind == Kind::WELD || data.kind == Kind::SLIDER;
    if ((!has_length && !has_point) || !m_joints[i].exists()) continue;
    const Vec2 between = anchorOf(data, true) - anchorOf(data, false);
    double opening = length(between);
    double lever = 0;
    if (has_length) {
      const double rest = data.length > 0 ? data.length : length(data.point_b - data.point_a);
      opening -= rest;
      if (data.kind == Kind::DISTANCE) opening = std::abs(opening);
      lever = rest;
    }
    if (data.kind == Kind::SLIDER) {
      Vec2 axis = data.axis / length(data.axis);
      if (const HuntBody* p_a = bodyAt(data.a); p_a != nullptr)
        axis = rotationBy(p_a->getAngle()) *
               (inverse(rotationBy(m_now.bodies[static_cast<std::size_t>(data.a)].angle)) * axis);
      opening = std::abs(cross(axis, between));
    }
    for (const int index : {data.a, data.b}) {
      if (index == kNothing) continue;
      const auto at = static_cast<std::size_t>(index);
      const Vec2 point = index == data.a ? data.point_a : data.point_b;
      lever = std::max({lever, m_body_solids[at].reach, length(point - m_now.bodies[at].place)});
    }
    // A sub-step of the fast level moves straight on, though the joint turns.
    const double turn = m_now.level == df::ACCURACY_FAST ? .25 * turnOf(data, lever) : 0;
    tick.opening = std::max(tick.opening, opening / lever - turn * turn);
    tick.shift += std::max(opening, 0.0);
  }
}

// Returns a bound of the angle by which the joint turns in this tick.
double LiveScene::turnOf(const JointData& joint, double lever) const {
  double turn = 0;
  const std::vector<Tick>& ticks = m_recording.ticks;
  for (std::size_t i = ticks.size() - std::min<std::size_t>(ticks.size(), 2); i < ticks.size(); ++i) {
    Vec2 velocity;
    for (const int index : {joint.a, joint.b}) {
      if (index == kNothing) continue;
      const BodyState& state = ticks[i].bodies[static_cast<std::size_t>(index)];
      turn = std::max(turn, std::abs(state.spin));
      velocity = state.velocity - velocity;
    }
    turn = std::max(turn, length(velocity) / lever);
  }
  return turn;
}

const Solid* LiveScene::solidAt(int number) const {
  if (number >= 0)
    return bodyAt(number) != nullptr ? &m_body_solids[static_cast<std::size_t>(number)] : nullptr;
  const auto index = static_cast<std::size_t>(obstacleNumber(number));
  return number != kNothing && m_obstacles[index] != nullptr ? &m_obstacle_solids[index] : nullptr;
}

df::Solidness LiveScene::solidnessOf(int number) const {
  return number >= 0 ? m_now.bodies[static_cast<std::size_t>(number)].solidness
                     : m_now.obstacles[static_cast<std::size_t>(obstacleNumber(number))].solidness;
}

// Returns a lower bound of the distance. To sensors, shapes may be boxes.
double LiveScene::gapOf(int a, int b) const {
  const Solid &one = *solidAt(a), &other = *solidAt(b);
  if (solidnessOf(a) == df::HARD && solidnessOf(b) == df::HARD) return -depthOf(one, other);
  const auto reachOf = [this](int number, const Solid& solid) {
    if (number >= 0) return Vec2{solid.reach, solid.reach};
    return m_now.obstacles[static_cast<std::size_t>(obstacleNumber(number))].half;
  };
  const Vec2 reach = reachOf(a, one) + reachOf(b, other), apart = one.centre - other.centre;
  return std::max(std::abs(apart.x) - reach.x, std::abs(apart.y) - reach.y);
}

// Completes the events of the tick with the least gap of the pair, and records which contacts are open.
void LiveScene::recordContacts(Tick& tick) {
  constexpr double kApart = .1;
  for (ContactEvent& event : m_recording.events) {
    if (event.tick != m_tick || m_acted) continue;
    const Solid *p_first = solidAt(event.first), *p_second = solidAt(event.second);
    if (p_first != nullptr && p_second != nullptr)
      event.gap = gapOf(event.first, event.second) - travelOf(event.first) - travelOf(event.second);
  }
  for (const ContactEvent& event : m_recording.events) {
    if (event.tick != m_tick) continue;
    std::erase_if(m_open, [&](const OpenContact& open) {
      return open.receiver == event.receiver && open.other == event.other();
    });
    if (event.begins && bodyAt(event.receiver) != nullptr && bodyAt(event.receiver)->hasContactEnds())
      m_open.push_back({event.receiver, event.other(), false});
  }
  std::erase_if(m_open, [this](const OpenContact& open) { return bodyAt(open.receiver) == nullptr; });
  for (OpenContact& open : m_open) {
    open.apart = solidAt(open.other) == nullptr || solidnessOf(open.receiver) == df::SPECTRAL ||
                 solidnessOf(open.other) == df::SPECTRAL || gapOf(open.receiver, open.other) > kApart;
  }
  tick.open = m_open;
}

}  // namespace hunt
