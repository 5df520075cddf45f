// Draws random scenes. Each family of scenes is drawn by one function; Families.cpp has them.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include "HuntScene.h"
#include "shared/values/SplitMix64.h"

namespace hunt {

class SceneDraw {
 public:
  SceneDraw(SceneData& scene, std::uint64_t seed) : m_scene(scene), m_random(seed) {}

  /// Draws everything that is common to all families: gravity, aspect, level, obstacles' surface, material.
  void drawWorld();
  /// Draws bodies, obstacles and joints of a family, by weight; `is_small` excludes costly families.
  void drawFamily(bool is_small);
  /// Draws setters and deletions. Families that depend on them have drawn theirs already.
  void drawActions();

 private:
  // Random numbers.
  bool chance(double probability) { return m_random.unit() < probability; }
  int below(int n) { return static_cast<int>(m_random.below(static_cast<std::uint64_t>(n))); }
  double between(double low, double high) { return low + (high - low) * m_random.unit(); }
  double oneOf(std::initializer_list<double> values) {
    return *(values.begin() + below(static_cast<int>(values.size())));
  }
  Vec2 vectorUpTo(double most) {
    const double x = between(-most, most);
    return {x, between(-most, most)};
  }
  double speed();  ///< .01 … 30 cells per tick, mostly below 1
  double anyMass();

  // Parts of scenes.
  int addBody(Vec2 place, std::vector<Part> parts);
  BodyData& body(int index) { return m_scene.bodies[static_cast<std::size_t>(index)]; }
  int addObstacle(Vec2 centre, Vec2 half, int row = kNothing);
  /// Adds a joint with one point for both bodies.
  JointData& addJoint(JointData::Kind kind, int a, int b, Vec2 point);
  /// Adds a joint between the middles of two bodies, or from a point of the world to a body's middle.
  JointData& addLink(JointData::Kind kind, int a, int b, Vec2 world_point = {});
  void setSpring(JointData& joint, double mass);
  void setMaterial(BodyData& body);
  /// Draws a shape that fits into a circle of this radius.
  std::vector<Part> anyShape(double radius);
  std::vector<Part> anyPolygon(double radius);
  void addFloor(double half_width = 500);
  /// Adds a row of tiles from `from` to the right: Objects, or kinematic bodies. Returns the row's number.
  int addTiles(Vec2 from, int count, double size, double gap, bool as_bodies, Vec2 velocity);
  /// Adds four walls of this thickness around the origin, of Objects or kinematic bodies.
  void addRoom(Vec2 half, double thickness, bool as_bodies, Vec2 velocity);
  /// Exchanges x and y of everything, or reverses y.
  void transpose();
  void turnOver();

  // Families.
  void drawTiles();
  void drawStairs(double size, bool as_bodies);
  void drawSlider(double from, double size);
  void drawPush();
  void drawChain();
  void drawMotor();
  void drawElastic();
  void drawContact();
  void drawZone();
  void drawHeap();
  void drawPlanks();
  void drawBars();
  void drawShot();
  void drawFields();
  void drawMix();
  void drawMixJoint(int a, int b);

  void addAction(std::span<const Action::Kind> kinds, int tick);
  void drawValues(Action& action);

  SceneData& m_scene;
  naiad::SplitMix64 m_random;
  int m_material = 0;
};

/// Makes the only part of a body.
std::vector<Part> circle(double radius);
std::vector<Part> box(double width, double height);

}  // namespace hunt
