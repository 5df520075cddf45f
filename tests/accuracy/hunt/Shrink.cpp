#include "Shrink.h"

#include <cmath>
#include <functional>

namespace hunt {
namespace {

class Shrinker {
 public:
  Shrinker(const SceneData& scene, const Judge& judge, int tries)
      : m_scene(scene),
        m_judge(judge),
        m_tries(tries),
        m_keeps_walls(judge.name == "through"),
        m_starts_apart(startsApart(scene)) {}

  SceneData result() {
    attempt([](SceneData&) {});
    while (m_tries > 0 && shrinkOnce()) {
    }
    return m_scene;
  }

 private:
  bool shrinkOnce() {
    const int ticks = m_tick + 1;
    bool done = ticks < m_scene.ticks && attempt([&](SceneData& its) { its.ticks = ticks; });
    done |= removeFrom(&SceneData::actions) | removeFrom(&SceneData::joints);
    for (std::size_t i = m_scene.bodies.size(); i-- > 0;) {
      if (isRemovable(i)) done |= attempt([&](SceneData& its) { removeBody(its, static_cast<int>(i)); });
    }
    if (!m_keeps_walls) done |= removeFrom(&SceneData::obstacles);
    done |= simplify([](SceneData& its) -> double& { return its.aspect; }, {1}) |
            simplify([](SceneData& its) -> double& { return its.obstacle_restitution; }, {0}) |
            simplify([](SceneData& its) -> double& { return its.obstacle_friction; }, {0, .5}) |
            simplify([](SceneData& its) -> double& { return its.gravity.x; }, {0}) |
            simplify([](SceneData& its) -> double& { return its.gravity.y; }, {0, .01});
    for (std::size_t i = 0; i < m_scene.bodies.size(); ++i) done |= isRemovable(i) && simplifyBody(i);
    return done;
  }

  static bool startsApart(SceneData scene) {
    scene.ticks = 0;
    return !run(scene, Detail::ALL).ticks.front().displaced;
  }

  bool isRemovable(std::size_t body) const {
    return m_scene.bodies[body].present && !(m_keeps_walls && m_scene.bodies[body].kinematic);
  }

  // Keeps a change if the judge still finds a violation.
  bool attempt(const std::function<void(SceneData&)>& change) {
    if (m_tries-- <= 0) return false;
    SceneData changed = m_scene;
    change(changed);
    if (m_starts_apart && !startsApart(changed)) return false;
    const Answer answer = judgeScene(changed, &m_judge).front().second;
    if (!answer.finding) return false;
    m_scene = changed;
    m_tick = answer.finding->tick;
    return true;
  }

  template <class Element>
  bool removeFrom(std::vector<Element> SceneData::*list) {
    bool done = false;
    for (std::size_t i = (m_scene.*list).size(); i-- > 0;) {
      if ((m_scene.*list)[i].present)
        done |= attempt([&](SceneData& its) { (its.*list)[i].present = false; });
    }
    return done;
  }

  static void removeBody(SceneData& scene, int body) {
    at(scene.bodies, body).present = false;
    for (JointData& its : scene.joints) its.present &= its.a != body && its.b != body;
    for (Action& its : scene.actions)
      its.present &= its.receiver != body && (its.p_setter->target != TargetKind::BODY || its.target != body);
  }

  // Sets a number of the scene to a simpler one.
  bool simplify(const std::function<double&(SceneData&)>& number, std::initializer_list<double> simpler) {
    const double now = number(m_scene);
    for (const double value : simpler) {
      if (value == now) return false;
      if (attempt([&](SceneData& its) { number(its) = value; })) return true;
    }
    return false;
  }

  bool simplifyBody(std::size_t i) {
    bool done = false;
    const auto try_if = [&](bool condition, void (*change)(BodyData&)) {
      done |= condition && attempt([&](SceneData& its) { change(its.bodies[i]); });
    };
    for (double BodyData::*field :
         {&BodyData::mass, &BodyData::restitution, &BodyData::spin, &BodyData::angle, &BodyData::linear_drag,
          &BodyData::quadratic_drag, &BodyData::damping, &BodyData::stiffness, &BodyData::friction}) {
      const auto number = [=](SceneData& its) -> double& { return its.bodies[i].*field; };
      if (field == &BodyData::friction) done |= simplify(number, {0, .5});
      if (field != &BodyData::friction) done |= simplify(number, {field == &BodyData::mass ? 1.0 : 0.0});
    }
    const BodyData body = m_scene.bodies[i];
    const bool is_fixed = body.row != kNothing || any(m_scene.joints, [](auto&) { return true; });
    for (Vec2 BodyData::*field : {&BodyData::velocity, &BodyData::place}) {
      for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
        const double now = m_scene.bodies[i].*field.*axis;
        done |= (!is_fixed || (field == &BodyData::velocity && body.row == kNothing)) &&
                simplify([=](SceneData& its) -> double& { return its.bodies[i].*field.*axis; },
                         {0, std::round(now), std::round(10 * now) / 10, std::round(100 * now) / 100});
      }
    }
    try_if(body.turning, [](BodyData& its) { its.turning = false; });
    try_if(body.field != kNothing, [](BodyData& its) { its.field = kNothing; });
    try_if(body.parts.size() > 1, [](BodyData& its) { its.parts.resize(1); });
    try_if(body.isDynamic() && (body.parts.size() != 1 || body.parts[0].size != Vec2{1, 1}),
           [](BodyData& its) { its.parts = {Part{}}; });
    return done;
  }

  SceneData m_scene;
  const Judge& m_judge;
  int m_tries;
  const bool m_keeps_walls;  // the judge assumes that no boundary is missing
  const bool m_starts_apart;
  int m_tick = 0;  // of the violation
};

}  // namespace

SceneData shrink(const SceneData& scene, const Judge& judge, int tries) {
  SceneData whole = scene;
  if (judge.name == "isolation") addDistantGroup(whole);
  return Shrinker(whole, judge, tries).result();
}

}  // namespace hunt
