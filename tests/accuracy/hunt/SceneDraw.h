// Draws the parts of random scenes. Families.cpp makes scenes of them.
#pragma once

#include <initializer_list>
#include <vector>

#include "HuntScene.h"
#include "shared/values/SplitMix64.h"

namespace hunt {

class SceneDraw {
 public:
  SceneDraw(SceneData& scene, std::uint64_t seed) : m_scene(scene), m_random(seed) {}
  /// Draws everything that is common to all families: gravity, aspect, level, obstacles' surface, material.
  void drawWorld();
  /// Draws setters and deletions. Families that depend on them have drawn theirs already.
  void drawActions();

 protected:
  bool chance(double probability) { return m_random.unit() < probability; }
  int below(int n) { return static_cast<int>(m_random.below(static_cast<std::uint64_t>(n))); }
  double between(double low, double high) { return low + (high - low) * m_random.unit(); }
  template <class Element>
  Element oneOf(const std::vector<Element>& list) {
    return at(list, below(static_cast<int>(list.size())));
  }
  double oneOf(std::initializer_list<double> values) { return oneOf(std::vector<double>(values)); }
  Vec2 vectorUpTo(double most) {
    const double x = between(-most, most);
    return {x, between(-most, most)};
  }
  double speed();  ///< .01 … 30 cells per tick, mostly below 1
  double mass();

  BodyData& addBody(Vec2 place, std::vector<Part> parts);
  BodyData& body(int index) { return at(m_scene.bodies, index); }
  int lastBody() const { return static_cast<int>(m_scene.bodies.size()) - 1; }
  BodyData& addObstacle(Vec2 centre, Vec2 half);
  /// Adds an obstacle, or a kinematic body.
  BodyData& addWall(Vec2 centre, Vec2 half, bool as_body, Vec2 velocity = {});
  void addBoundary(Boundary::Kind kind, Vec2 lower, Vec2 upper, Vec2 velocity = {}) {
    m_scene.boundaries.push_back({kind, lower, upper, velocity});
  }
  void addFloor(double half_width = 500, double top = 0);
  /// Adds a row of tiles from `from` to the right: Objects, or kinematic bodies.
  void addTiles(Vec2 from, int count, double size, double gap = 0, bool as_bodies = false,
                Vec2 velocity = {});
  /// Adds four walls of this thickness around the origin, of Objects or kinematic bodies.
  void addRoom(Vec2 half, double thickness, bool as_bodies, Vec2 velocity);
  /// Adds a joint with one point for both bodies.
  JointData& addJoint(JointData::Kind kind, int a, int b, Vec2 point);
  /// Adds a joint between the middles of two bodies, or from a point of the world to a body's middle.
  JointData& addLink(JointData::Kind kind, int a, int b, Vec2 world_point = {});
  void setSpring(JointData& joint);
  /// Draws a shape that fits into a circle of this radius.
  std::vector<Part> anyShape(double radius);
  std::vector<Part> anyPolygon(double radius);
  /// Exchanges x and y of everything, or reverses y.
  void transpose();
  void turnOver();
  void addAction(const std::vector<const char*>& names, int tick);

  SceneData& m_scene;
  int m_material = 0;

 private:
  template <class Change>
  void changeVectors(Change change);

  naiad::SplitMix64 m_random;
};

/// Makes the only part of a body.
std::vector<Part> circle(double radius);
std::vector<Part> box(double width, double height);

}  // namespace hunt
