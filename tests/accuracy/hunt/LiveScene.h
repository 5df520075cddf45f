// A world that was built from a scene through the public API, and what is recorded of it.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Recording.h"
#include "Script.h"
#include "Solids.h"
#include "engine/world/World.h"
#include "physics/body/Body.h"
#include "physics/body/Field.h"

namespace hunt {

class LiveScene;

class HuntField : public df::Field {
 public:
  explicit HuntField(const FieldData& data) : m_data(data) {}
  df::Vector accelerationAt(df::Vector displacement, df::Vector velocity, double time) const override;

 private:
  FieldData m_data;
};

class HuntBody : public df::Body {
 public:
  HuntBody(LiveScene& scene, int index) : m_scene(scene), m_index(index) {}
  ~HuntBody() override;
  int eventHandler(const df::Event* p_event) override;
  /// Returns the expression for this body in a Script.
  std::string code() const { return "bodies[" + std::to_string(m_index) + "]"; }

 private:
  LiveScene& m_scene;
  int m_index;
};

class HuntObstacle : public df::Object {
 public:
  HuntObstacle(LiveScene& scene, int index) : m_scene(scene), m_index(index) {}
  ~HuntObstacle() override;

 private:
  LiveScene& m_scene;
  int m_index;
};

class LiveScene {
 public:
  LiveScene(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start, bool writes);
  ~LiveScene() { m_world.shutDown(); }
  LiveScene(const LiveScene&) = delete;
  LiveScene& operator=(const LiveScene&) = delete;

  /// Runs the scene. Call once.
  Recording record();
  /// Returns the calls since the start as a program.
  std::string program(const std::string& comment) const;
  void forgetBody(int index) { m_bodies[static_cast<std::size_t>(index)] = nullptr; }
  void forgetObstacle(int index) { m_obstacles[static_cast<std::size_t>(index)] = nullptr; }
  void onContact(int receiver, bool begins, const df::Object* p_first, const df::Object* p_second);

 private:
  df::Vector cells(Vec2 metric) const { return {metric.x, metric.y / m_now.aspect}; }
  Vec2 metric(df::Vector cells) const { return {cells.x(), cells.y() * m_now.aspect}; }
  HuntBody* bodyAt(int index) const {
    return index == kNothing ? nullptr : m_bodies[static_cast<std::size_t>(index)];
  }

  void addGroup(int group);
  void addBody(std::size_t index);
  void addPart(HuntBody& body, const std::string& on, const Part& part, bool is_first);
  void addObstacle(std::size_t index);
  void addJoint(std::size_t index);
  void setStates(const std::vector<BodyState>& states);

  void actAt(int tick);
  void act(Action& action);
  void actOnBody(const Action& action, HuntBody& body, BodyData& data);
  void actOnObstacle(const Action& action, HuntObstacle& obstacle, ObstacleData& data);
  void actOnJoint(const Action& action, df::Joint& joint, JointData& data);
  void actOnWorld(const Action& action);

  void recordTick();
  Sums sums() const;
  void addPotential(std::size_t index, Sums& sums) const;
  void addJointPotential(std::size_t index, Sums& sums) const;
  void recordSolids(Tick& tick);
  void recordOpenings(Tick& tick) const;
  void recordContacts(Tick& tick);
  Solid solidOf(std::size_t body) const;
  Solid solidOf(const ObstacleData& obstacle) const;
  void recordPair(Tick& tick, int a, int b);
  double turnOf(const JointData& joint, double lever) const;
  bool areJoined(int a, int b) const;
  double travelOf(int number) const { return number < 0 ? 0 : m_travels[static_cast<std::size_t>(number)]; }
  const Solid* solidAt(int number) const;
  double gapOf(int a, int b) const;
  df::Solidness solidnessOf(int number) const;
  Vec2 anchorOf(const JointData& joint, bool second) const;

  const Detail m_detail;
  SceneData m_now;
  Recording m_recording;
  Script m_script;
  df::World m_world;
  df::World::Scope m_scope{m_world};
  std::vector<std::unique_ptr<HuntField>> m_fields;
  std::vector<HuntBody*> m_bodies;
  std::vector<HuntObstacle*> m_obstacles;
  std::vector<df::Joint> m_joints;
  std::map<const df::Object*, int> m_numbers;
  int m_tick = 0;
  bool m_acted = false;                           // in this tick
  bool m_displaces = false, m_displaced = false;  // in this tick; ever
  std::vector<int> m_event_counts;                // by receiver
  std::vector<double> m_travels;                  // bounds of the bodies' motion in this tick
  std::vector<Solid> m_body_solids, m_obstacle_solids;
  std::vector<std::pair<int, int>> m_excluded;  // pairs that overlapped after an action or at the start
  std::vector<OpenContact> m_open;
};

}  // namespace hunt
