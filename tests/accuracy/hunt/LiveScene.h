// A world that was built from a scene through the public API.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "Recording.h"
#include "Script.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/Body.h"
#include "physics/body/Field.h"

namespace hunt {

class LiveScene;

class HuntBody : public df::Body {
 public:
  HuntBody(LiveScene& scene, int index) : m_scene(scene), m_index(index) {}
  int eventHandler(const df::Event* p_event) override;
  /// Returns the expression for this body in a Script.
  std::string code() const { return "bodies[" + std::to_string(m_index) + "]"; }

 private:
  LiveScene& m_scene;
  int m_index;
};

class LiveScene {
 public:
  /// Makes bodies and joints as the scene says. Then, if `p_start` is not null, gives the bodies those
  /// states.
  LiveScene(const SceneData& scene, const std::vector<BodyState>* p_start, bool writes);
  ~LiveScene() { m_world.shutDown(); }
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  /// Carries out the actions of the next tick, and updates the world.
  void update();
  /// Returns the calls since the start as a program.
  std::string program(const std::string& comment);
  void onContact(int receiver, const df::Event* p_event);

 protected:
  df::Vector cells(Vec2 metric) const { return {metric.x, metric.y / m_now.aspect}; }
  Vec2 metric(df::Vector cells) const { return {cells.x(), cells.y() * m_now.aspect}; }
  /// Return null for what is not there, or not any more.
  HuntBody* bodyAt(int index) const {
    return index == kNothing ? nullptr : static_cast<HuntBody*>(m_world.store().find(at(m_bodies, index)));
  }
  df::Object* obstacleAt(int index) const { return m_world.store().find(at(m_obstacles, index)); }
  /// Returns the data of a body or an obstacle.
  const BodyData& dataOf(int number) const {
    return number >= 0 ? at(m_now.bodies, number) : at(m_now.obstacles, obstacleNumber(number));
  }

  SceneData m_now;
  Script m_script;
  df::World m_world;
  df::World::Scope m_scope{m_world};
  std::vector<std::unique_ptr<df::Field>> m_fields;
  std::vector<df::ObjectKey> m_bodies, m_obstacles;
  std::vector<df::Joint> m_joints;
  std::vector<ContactEvent> m_events;
  int m_tick = 0;
  bool m_acted = false;                           // in this tick
  bool m_displaces = false, m_displaced = false;  // in this tick; ever

 private:
  void addBody(int index);
  void addPart(HuntBody& body, const Part& part, bool is_first);
  void addObstacle(int index);
  void addJoint(int index);
  void act(Action& action);
  void actOnBody(const Action& action, HuntBody& body, BodyData& data);
  void actOnObstacle(const Action& action, df::Object& obstacle, BodyData& data);
  void actOnJoint(const Action& action, df::Joint& joint, JointData& data);
  void actOnWorld(const Action& action);

  std::string m_on;  // code in front of the function of the next call
  std::map<const df::Object*, int> m_numbers;
  std::vector<int> m_event_counts;  // by receiver
};

}  // namespace hunt
