#include "Shrink.h"

#include <algorithm>
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
        m_keeps_walls(judge.name == std::string("through")),
        m_starts_apart(startsApart(scene)) {}

  SceneData result() {
    while (m_tries > 0 && shrinkOnce()) {
    }
    return m_scene;
  }

 private:
  bool shrinkOnce() {
    bool has_shrunk = shorten();
    has_shrunk |= removeFrom(&SceneData::actions) | removeFrom(&SceneData::joints);
    for (std::size_t i = m_scene.bodies.size(); i-- > 0;) {
      if (m_scene.bodies[i].present && !isWall(m_scene.bodies[i]))
        has_shrunk |= attempt([i](SceneData& scene) { removeBody(scene, i); });
    }
    if (!m_keeps_walls) has_shrunk |= removeFrom(&SceneData::obstacles);
    return has_shrunk | simplify();
  }

  static bool startsApart(SceneData scene) {
    scene.ticks = 0;
    return !run(scene, Detail::ALL).ticks.front().displaced;
  }

  bool isWall(const BodyData& body) const { return m_keeps_walls && body.kinematic; }

  // Keeps a change if the judge still finds a violation.
  bool attempt(const std::function<void(SceneData&)>& change) {
    if (m_tries-- <= 0) return false;
    SceneData changed = m_scene;
    change(changed);
    if (m_starts_apart && !startsApart(changed)) return false;
    const std::vector<Verdict> verdicts = judgeScene(changed, &m_judge);
    if (!verdicts.front().finding) return false;
    m_scene = changed;
    m_tick = verdicts.front().finding->tick;
    return true;
  }

  bool shorten() {
    if (m_tick < 0) attempt([](SceneData&) {});
    const int ticks = m_tick + 1;
    return m_tick >= 0 && ticks < m_scene.ticks && attempt([&](SceneData& its) { its.ticks = ticks; });
  }

  template <class Element>
  bool removeFrom(std::vector<Element> SceneData::*list) {
    bool has_shrunk = false;
    for (std::size_t i = (m_scene.*list).size(); i-- > 0;) {
      if ((m_scene.*list)[i].present)
        has_shrunk |= attempt([&](SceneData& scene) { (scene.*list)[i].present = false; });
    }
    return has_shrunk;
  }

  static void removeBody(SceneData& scene, std::size_t body) {
    const int index = static_cast<int>(body);
    scene.bodies[body].present = false;
    for (JointData& joint : scene.joints) joint.present &= joint.a != index && joint.b != index;
    for (Action& action : scene.actions) {
      const bool concerns =
          action.receiver == index || (targetOf(action.kind) == TargetKind::BODY && action.target == index);
      action.present &= !concerns;
    }
  }

  // Sets a number of the scene to a simpler one.
  template <class Get>
  bool simplifyNumber(Get get, std::initializer_list<double> simpler) {
    const double now = get(m_scene);
    for (const double value : simpler) {
      if (value == now) return false;
      if (attempt([&](SceneData& scene) { get(scene) = value; })) return true;
    }
    return false;
  }

  bool simplify() {
    bool done = simplifyNumber([](SceneData& its) -> double& { return its.aspect; }, {1});
    done |= simplifyNumber([](SceneData& its) -> double& { return its.obstacle_restitution; }, {0});
    done |= simplifyNumber([](SceneData& its) -> double& { return its.obstacle_friction; }, {0, .5});
    done |= simplifyNumber([](SceneData& its) -> double& { return its.gravity.x; }, {0});
    done |= simplifyNumber([](SceneData& its) -> double& { return its.gravity.y; }, {0, .01});
    for (std::size_t i = 0; i < m_scene.bodies.size(); ++i) {
      if (m_scene.bodies[i].present && !isWall(m_scene.bodies[i])) done |= simplifyBody(i);
    }
    return done;
  }

  bool simplifyBody(std::size_t i) {
    const auto number = [this, i](double BodyData::*field, std::initializer_list<double> simpler) {
      return simplifyNumber([i, field](SceneData& its) -> double& { return its.bodies[i].*field; }, simpler);
    };
    const auto vector = [this, i](Vec2 BodyData::*field) {
      bool done = false;
      for (double Vec2::*axis : {&Vec2::x, &Vec2::y}) {
        const double now = m_scene.bodies[i].*field.*axis;
        done |= simplifyNumber([=](SceneData& its) -> double& { return its.bodies[i].*field.*axis; },
                               {0, std::round(now), std::round(10 * now) / 10, std::round(100 * now) / 100});
      }
      return done;
    };
    bool done = number(&BodyData::mass, {1}) | number(&BodyData::restitution, {0}) |
                number(&BodyData::friction, {0, .5}) | number(&BodyData::spin, {0}) |
                number(&BodyData::angle, {0}) | number(&BodyData::linear_drag, {0}) |
                number(&BodyData::quadratic_drag, {0}) | number(&BodyData::damping, {0}) |
                number(&BodyData::stiffness, {0});
    done |= vector(&BodyData::velocity);
    const bool is_joined = std::any_of(m_scene.joints.begin(), m_scene.joints.end(),
                                       [](const JointData& joint) { return joint.present; });
    if (!is_joined) done |= vector(&BodyData::place);
    if (m_scene.bodies[i].turning) done |= attempt([i](SceneData& its) { its.bodies[i].turning = false; });
    if (m_scene.bodies[i].field != kNothing)
      done |= attempt([i](SceneData& its) { its.bodies[i].field = kNothing; });
    if (m_scene.bodies[i].parts.size() > 1)
      done |= attempt([i](SceneData& its) { its.bodies[i].parts.resize(1); });
    const bool is_unit = m_scene.bodies[i].parts.size() == 1 && m_scene.bodies[i].parts[0].size == Vec2{1, 1};
    if (!is_unit && m_scene.bodies[i].isDynamic())
      done |= attempt([i](SceneData& its) { its.bodies[i].parts = {Part{}}; });
    return done;
  }

  SceneData m_scene;
  const Judge& m_judge;
  int m_tries;
  const bool m_keeps_walls;  // the judge assumes that no boundary is missing
  const bool m_starts_apart;
  int m_tick = -1;  // of the violation
};

}  // namespace

SceneData shrink(const SceneData& scene, const Judge& judge, int tries) {
  SceneData whole = scene;
  if (std::string(judge.name) == "isolation") addDistantGroup(whole);
  return Shrinker(whole, judge, tries).result();
}

}  // namespace hunt
