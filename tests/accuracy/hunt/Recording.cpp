#include "Recording.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "LiveScene.h"
#include "Solids.h"
#include "physics/geometry/Rotation.h"

namespace hunt {
namespace {

using naiad::physics::inverse;
using naiad::physics::rotationBy;
using Kind = JointData::Kind;

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

std::vector<Vec2> cornersOf(Vec2 lower, Vec2 upper) {
  return {lower, {upper.x, lower.y}, upper, {lower.x, upper.y}};
}

class Recorder : public LiveScene {
 public:
  Recorder(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start)
      : LiveScene(scene, p_start, false), m_detail(detail) {
    for (auto* p_list : {&m_body_solids, &m_obstacle_solids})
      p_list->resize(std::max(scene.bodies.size(), scene.obstacles.size()));
    m_travels.resize(scene.bodies.size());
  }

  Recording record() {
    recordTick();
    while (m_tick < m_now.ticks) {
      update();
      recordTick();
    }
    m_recording.frozen = PM.getQuarantineCount();
    m_recording.limited = PM.getLimitCount();
    for (std::size_t i = 0; i < m_joints.size(); ++i) {
      if (!m_joints[i].exists()) m_now.joints[i].present = false;  // it broke, or lost a body
    }
    m_recording.end = m_now;
    m_recording.events = m_events;
    return std::move(m_recording);
  }

 private:
  void recordTick() {
    Tick& tick = m_recording.ticks.emplace_back();
    tick.acted = m_acted;
    tick.displaced = m_displaced;
    for (int i = 0; i < static_cast<int>(m_bodies.size()); ++i) {
      BodyState& state = tick.bodies.emplace_back();
      if (const HuntBody* p_body = bodyAt(i); p_body != nullptr)
        state = {placeOf(*p_body),  velocityOf(*p_body), p_body->getAngle(), p_body->getSpin(), true,
                 p_body->isFrozen()};
    }
    if (m_detail == Detail::STATES) return;
    recordSums(tick.sums);
    recordSolids(tick);
    recordOpenings(tick);
    recordContacts(tick);
  }

  Vec2 placeOf(const HuntBody& body) const { return metric(body.getPosition()); }
  Vec2 velocityOf(const HuntBody& body) const { return metric(body.getVelocity()); }

  template <class Add>
  void forFreeBodies(Add add) const {
    for (int i = 0; i < static_cast<int>(m_bodies.size()); ++i) {
      const BodyData& data = dataOf(i);
      if (bodyAt(i) != nullptr && !data.kinematic && data.group == 0) add(*bodyAt(i), data);
    }
  }

  void recordSums(Sums& sums) const {
    double mass = 0;
    Vec2 middle;
    forFreeBodies([&](const HuntBody& body, const BodyData& data) {
      mass += data.mass;
      middle += data.mass * placeOf(body);
      sums.momentum += data.mass * velocityOf(body);
      sums.force += data.mass * data.gravity_scale * m_now.gravity;
      addPotential(placeOf(body), data, sums);
    });
    if (mass == 0) return;
    middle = middle / mass;
    const Vec2 drift = sums.momentum / mass;
    forFreeBodies([&](const HuntBody& body, const BodyData& data) {
      const Vec2 v = velocityOf(body), from = placeOf(body) - middle;
      const double turning = body.isTurning() ? body.getInertia() * body.getSpin() : 0;
      sums.kinetic += .5 * (data.mass * dot(v, v) + turning * body.getSpin());
      sums.momentum_scale += data.mass * length(v);
      sums.angular += turning + data.mass * cross(from, v - drift);
      sums.angular_scale += std::abs(turning) + data.mass * length(from) * length(v - drift);
    });
    for (std::size_t i = 0; i < m_joints.size(); ++i) {
      if (m_joints[i].exists() && m_now.groupOf(m_now.joints[i]) == 0) addPotential(m_now.joints[i], sums);
    }
  }

  void addPotential(Vec2 place, const BodyData& data, Sums& sums) const {
    const Vec2 weight = data.mass * data.gravity_scale * m_now.gravity;
    sums.potential -= dot(weight, place);
    sums.pull += length(weight);
    sums.rest += .5 * dot(weight, weight) / (16 * data.mass);
    const auto addLinear = [&](double stiffness, Vec2 d) {
      (stiffness > kStiff ? sums.stiff : sums.potential) += .5 * data.mass * stiffness * dot(d, d);
      sums.pull += data.mass * stiffness * length(d);
    };
    if (data.stiffness > 0) addLinear(data.stiffness, place - data.anchor);
    if (data.field == kNothing) return;
    const FieldData& field = at(m_now.fields, data.field);
    const Vec2 d = place - data.field_origin;
    if (field.kind == FieldData::Kind::LINEAR) addLinear(field.strength, d);
    if (field.kind == FieldData::Kind::TANH) {
      (field.strength * field.steepness > kStiff ? sums.stiff : sums.potential) +=
          data.mass * field.strength *
          (tanhPotential(field.steepness, d.x) + tanhPotential(field.steepness, d.y));
      sums.pull += 2 * data.mass * field.strength;
    }
  }

  void addPotential(const JointData& data, Sums& sums) const {
    if (data.kind == Kind::SPRING) {
      const double stretch = length(betweenEnds(data)) - data.restLength();
      double lightest = std::numeric_limits<double>::infinity();
      for (const int end : {data.a, data.b}) {
        if (end != kNothing) lightest = std::min(lightest, dataOf(end).mass);
      }
      (data.first > kStiff * lightest ? sums.stiff : sums.potential) += .5 * data.first * stretch * stretch;
      sums.pull += data.first * std::abs(stretch);
    } else if (data.kind == Kind::MOUSE) {
      const Vec2 d = anchorOf(data.b, data.point_b) - data.target;
      sums.potential +=
          limitedPotential(data.second, d.x, data.first) + limitedPotential(data.second, d.y, data.first);
      sums.pull += std::min(data.second * length(d), 2 * data.first);
    }
  }

  // Returns where a point of a body at the start is now.
  Vec2 anchorOf(int body, Vec2 point) const {
    if (body == kNothing) return point;
    return placeOf(*bodyAt(body)) + turned(body, point - dataOf(body).place);
  }
  Vec2 betweenEnds(const JointData& its) const {
    return anchorOf(its.b, its.point_b) - anchorOf(its.a, its.point_a);
  }
  Vec2 turned(int body, Vec2 vector) const {
    return rotationBy(bodyAt(body)->getAngle()) * (inverse(rotationBy(dataOf(body).angle)) * vector);
  }

  Solid solidOf(const HuntBody& body) const {
    Solid solid;
    solid.centre = placeOf(body);
    const auto rotation = rotationBy(body.getAngle());
    for (const naiad::physics::ConvexShape& shape : body.getShapes()) {
      SolidPart& part = solid.parts.emplace_back();
      part.radius = shape.radius;
      for (int i = 0; i < shape.count; ++i)
        part.points.push_back(solid.centre + rotation * at(shape.vertices, i));
    }
    if (solid.parts.empty()) {  // the Object's box, which does not turn
      const Vec2 lower = solid.centre + metric(body.getBox().getCorner());
      solid.parts = {{cornersOf(lower, lower + metric({body.getBox().width(), body.getBox().height()}))}};
    }
    measure(solid);
    return solid;
  }

  bool areJoined(int a, int b) const {
    for (std::size_t i = 0; i < m_joints.size(); ++i) {
      const JointData& its = m_now.joints[i];
      if (((its.a == a && its.b == b) || (its.a == b && its.b == a)) && m_joints[i].exists()) return true;
    }
    return false;
  }

  const BodyState& stateBefore(int body) const {
    const std::vector<Tick>& ticks = m_recording.ticks;
    return at(ticks[ticks.size() - std::min<std::size_t>(ticks.size(), 2)].bodies, body);
  }

  void recordSolids(Tick& tick) {
    const int bodies = static_cast<int>(m_bodies.size()), obstacles = static_cast<int>(m_obstacles.size());
    for (int i = 0; i < bodies; ++i) {
      Solid& solid = at(m_body_solids, i);
      solid = bodyAt(i) != nullptr ? solidOf(*bodyAt(i)) : Solid{};
      const BodyState &from = stateBefore(i), &to = at(tick.bodies, i);
      at(m_travels, i) = length(to.place - from.place) + length(from.velocity) + length(to.velocity) +
                         solid.reach * std::max(std::abs(from.spin), std::abs(to.spin));
    }
    for (int i = 0; i < obstacles && (m_acted || m_tick == 0); ++i) {
      const BodyData& data = at(m_now.obstacles, i);
      Solid& solid = at(m_obstacle_solids, i);
      solid = {};
      if (obstacleAt(i) == nullptr) continue;
      solid.centre = data.place;
      solid.parts = {{cornersOf(data.place - data.half(), data.place + data.half())}};
      measure(solid);
    }
    for (int i = 0; i < bodies; ++i) {
      for (int j = i + 1; j < bodies; ++j) recordPair(tick, i, j);
      for (int j = 0; j < obstacles; ++j) recordPair(tick, i, obstacleNumber(j));
    }
  }

  // Returns null for what does not exist.
  const Solid* solidAt(int number) const {
    if (number >= 0) return bodyAt(number) != nullptr ? &at(m_body_solids, number) : nullptr;
    const int index = obstacleNumber(number);
    return number != kNothing && obstacleAt(index) != nullptr ? &at(m_obstacle_solids, index) : nullptr;
  }

  // Returns how far the element can have moved in this tick.
  double travelOf(int number) const { return number < 0 ? 0 : at(m_travels, number); }

  void recordPair(Tick& tick, int a, int b) {
    const Solid *p_a = solidAt(a), *p_b = solidAt(b);
    if (p_a == nullptr || p_b == nullptr || !areHard(a, b)) return;
    const bool is_dynamic = dataOf(a).isDynamic(), is_other = dataOf(b).isDynamic();
    if (!is_dynamic && !is_other) return;
    const double depth = depthOf(*p_a, *p_b);
    const auto found = std::find(m_excluded.begin(), m_excluded.end(), std::pair(a, b));
    if (depth <= 0 && found != m_excluded.end()) m_excluded.erase(found);
    if (depth <= 0 || found != m_excluded.end()) return;
    const bool are_joined = areJoined(a, b);
    if ((m_displaces || m_tick == 0) && depth > 1e-9) {
      m_excluded.emplace_back(a, b);
      if (!are_joined) tick.displaced = m_displaced = true;
      return;
    }
    if (are_joined) return;
    // Bodies that move fast overlap between a step's search and the next.
    const double unavoidable = (m_now.isFast() ? .25 : .05) * (travelOf(a) + travelOf(b));
    const double thickness =
        std::min(is_dynamic ? p_a->thickness : p_b->thickness, is_other ? p_b->thickness : p_a->thickness);
    tick.depth = std::max(tick.depth, (depth - unavoidable) / thickness);
    tick.shift += depth;
  }

  void recordOpenings(Tick& tick) const {
    for (std::size_t i = 0; i < m_joints.size(); ++i) {
      const JointData& data = m_now.joints[i];
      const bool has_length = data.kind == Kind::DISTANCE || data.kind == Kind::ROPE;
      const bool has_point = data.kind == Kind::HINGE || data.kind == Kind::WELD || data.kind == Kind::SLIDER;
      if ((!has_length && !has_point) || !m_joints[i].exists()) continue;
      const Vec2 between = betweenEnds(data);
      double opening = length(between), lever = has_length ? data.restLength() : 0;
      if (has_length) opening -= lever;
      if (data.kind == Kind::DISTANCE) opening = std::abs(opening);
      if (data.kind == Kind::SLIDER) {
        const Vec2 axis = data.axis / length(data.axis);
        opening = std::abs(cross(data.a != kNothing ? turned(data.a, axis) : axis, between));
      }
      for (const int index : {data.a, data.b}) {
        if (index == kNothing) continue;
        const Vec2 point = index == data.a ? data.point_a : data.point_b;
        lever = std::max({lever, at(m_body_solids, index).reach, length(point - dataOf(index).place)});
      }
      // A sub-step of the fast level moves straight on, though the joint turns.
      const double turn = m_now.isFast() ? .25 * turnOf(data, lever) : 0;
      tick.opening = std::max(tick.opening, opening / lever - turn * turn);
      tick.shift += std::max(opening, 0.0);
    }
  }

  // Returns a bound of the angle by which the joint turns in this tick.
  double turnOf(const JointData& joint, double lever) const {
    double turn = 0;
    for (const bool now : {false, true}) {
      Vec2 velocity;
      for (const int index : {joint.a, joint.b}) {
        if (index == kNothing) continue;
        const BodyState& state = now ? at(m_recording.ticks.back().bodies, index) : stateBefore(index);
        turn = std::max(turn, std::abs(state.spin));
        velocity = state.velocity - velocity;
      }
      turn = std::max(turn, length(velocity) / lever);
    }
    return turn;
  }

  bool areHard(int a, int b) const {
    return dataOf(a).solidness == df::HARD && dataOf(b).solidness == df::HARD;
  }

  // Returns a lower bound of the distance. To sensors, shapes may be boxes.
  double gapOf(int a, int b) const {
    const Solid &one = *solidAt(a), &other = *solidAt(b);
    if (areHard(a, b)) return -depthOf(one, other);
    const auto reachOf = [this](int number, const Solid& solid) {
      return number >= 0 ? Vec2{solid.reach, solid.reach} : dataOf(number).half();
    };
    const Vec2 reach = reachOf(a, one) + reachOf(b, other), apart = one.centre - other.centre;
    return std::max(std::abs(apart.x) - reach.x, std::abs(apart.y) - reach.y);
  }

  // Completes the events of the tick with the least gap of the pair, and records which contacts are open.
  void recordContacts(Tick& tick) {
    constexpr double kApart = .1;
    for (; m_complete < m_events.size(); ++m_complete) {
      ContactEvent& event = m_events[m_complete];
      const auto gone = std::find_if(m_open.begin(), m_open.end(), [&](const OpenContact& open) {
        return open.receiver == event.receiver && solidAt(open.other) == nullptr;
      });
      // An end event has no Object for a partner that was deleted.
      if (!event.begins && event.other() == kNothing && gone != m_open.end()) event.gone = gone->other;
      if (!m_acted && solidAt(event.first) != nullptr && solidAt(event.second) != nullptr)
        event.gap = gapOf(event.first, event.second) - travelOf(event.first) - travelOf(event.second);
      std::erase_if(m_open, [&](const OpenContact& open) {
        return open.receiver == event.receiver && open.other == event.other();
      });
      if (event.begins && bodyAt(event.receiver) != nullptr && bodyAt(event.receiver)->hasContactEnds())
        m_open.push_back({event.receiver, event.other(), m_tick});
    }
    std::erase_if(m_open, [this](const OpenContact& open) { return bodyAt(open.receiver) == nullptr; });
    for (OpenContact& open : m_open) {
      open.apart =
          open.since < m_tick &&
          (solidAt(open.other) == nullptr || dataOf(open.receiver).solidness == df::SPECTRAL ||
           dataOf(open.other).solidness == df::SPECTRAL || gapOf(open.receiver, open.other) > kApart);
    }
    tick.open = m_open;
  }

  const Detail m_detail;
  Recording m_recording;
  std::vector<double> m_travels;  // bounds of the bodies' motion in this tick
  std::vector<Solid> m_body_solids, m_obstacle_solids;
  std::vector<std::pair<int, int>> m_excluded;  // pairs that overlapped after an action or at the start
  std::size_t m_complete = 0;                   // number of events that recordContacts() has seen
  std::vector<OpenContact> m_open;
};

}  // namespace

Recording run(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start) {
  return Recorder(scene, detail, p_start).record();
}

}  // namespace hunt
