#include "Scenes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace lab {
namespace {

constexpr double kFriction = 0.6;

Scene sceneOf(int ticks) {
  Scene scene;
  scene.gravity = {0, 10};
  scene.ticks = ticks;
  scene.may_sleep = true;
  scene.has_full_sides = true;
  scene.counts_contacts = false;
  return scene;
}

// A scene of joints, in which nothing collides or sleeps.
Scene jointsOf(int ticks) {
  Scene scene = sceneOf(ticks);
  scene.may_sleep = false;
  scene.collides = false;
  return scene;
}

// Makes a box from the lengths of its sides.
Body boxOf(Vec position, double width, double height, double density = 1) {
  return crate(position, {width / 2, height / 2}, kFriction, density * width * height);
}

Body discOf(Vec position, double radius) {
  Body disc = ball(position, {}, radius, std::numbers::pi * radius * radius);
  disc.friction = kFriction;
  disc.rotates = true;
  return disc;
}

void addWall(Scene& scene, Vec centre, double width, double height) {
  scene.bodies.push_back(boxOf(centre, width, height));
  scene.bodies.back().motion = Motion::FIXED;
}

// Adds a floor with its top at y = 0.
void addFloor(Scene& scene, double centre, double width) {
  addWall(scene, {centre, 0.5}, width, 1);
  scene.room.upper.y = 0;
}

void addPyramid(Scene& scene, double centre, int rows) {
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      scene.bodies.push_back(boxOf({centre + i - 0.5 * (rows - row - 1), -0.5 - row}, 1, 1));
    }
  }
}

// Draws random shifts from raw numbers of std::mt19937, which are equal in every library, unlike those of
// distributions.
class Shift {
 public:
  double next() { return (static_cast<double>(m_random()) / kNumbers - 0.5) * 2 * kLargest; }

 private:
  static constexpr double kNumbers = 4294967296.0;
  static constexpr double kLargest = 0.1;
  static constexpr unsigned kSeed = 1;

  std::mt19937 m_random{kSeed};
};

// Rounds a length so that Objects, whose positions have units of 2^-32, are exactly in place.
double inWholeUnits(double length) {
  constexpr double kUnits = 65536;
  return std::round(length * kUnits) / kUnits;
}

Body heapBody(int index, Vec position) {
  if (index % 3 == 0) return discOf(position, 0.5);
  return boxOf(position, 1, index % 3 == 1 ? 1 : 0.6);
}

Scene makeHeap(int count, int ticks) {
  constexpr double kPitch = 1.3;
  Scene scene = sceneOf(ticks);
  const double half = inWholeUnits(0.8 * std::sqrt(count));
  const int columns = static_cast<int>(2 * half / kPitch);
  const int rows = (count + columns - 1) / columns;
  const double height = 2 * std::ceil(kPitch * rows / 2) + 10;
  addFloor(scene, 0, 2 * half + 4);
  for (const double side : {-1.0, 1.0}) addWall(scene, {side * (half + 0.5), -height / 2}, 1, height);
  scene.room.lower.x = -half;
  scene.room.upper.x = half;
  Shift shift;
  for (int i = 0; i < count; ++i) {
    const double x = -half + 0.7 + kPitch * (i % columns) + shift.next();
    const double y = -1 - kPitch * (i / columns) + shift.next();
    scene.bodies.push_back(heapBody(i, {x, y}));
  }
  return scene;
}

}  // namespace

Scene makePyramid(int rows) {
  Scene scene = sceneOf(14);
  addFloor(scene, 0, 160);
  addPyramid(scene, 0, rows);
  return scene;
}

Scene makePyramid60() {
  return makePyramid(60);
}

Scene makePyramids100() {
  Scene scene = sceneOf(14);
  for (int i = 0; i < 100; ++i) {
    addFloor(scene, 16 * i, 14);
    addPyramid(scene, 16 * i, 10);
  }
  return scene;
}

Scene makeTumbler500() {
  constexpr double kInside = 9.5;
  Scene scene = sceneOf(150);
  Body drum;
  drum.motion = Motion::KINEMATIC;
  drum.spin = 25 * std::numbers::pi / 180;
  drum.friction = kFriction;
  drum.rotates = true;
  for (const double side : {-10.0, 10.0}) drum.shapes.push_back({Shape::Kind::BOX, 0, {10, 0.5}, {0, side}});
  for (const double side : {-10.0, 10.0}) drum.shapes.push_back({Shape::Kind::BOX, 0, {0.5, 10}, {side, 0}});
  scene.bodies.push_back(drum);
  scene.room = {{-kInside, -kInside}, {kInside, kInside}, 0};
  for (int i = 0; i < 500; ++i) {
    const int column = i % 23;
    const int row = i / 23;
    scene.bodies.push_back(boxOf({0.4 * (column - 11), 0.4 * (row - 10.5)}, 0.25, 0.25));
  }
  return scene;
}

Scene makeHeap2000() {
  return makeHeap(2000, 100);
}

Scene makeHeap20000() {
  return makeHeap(20'000, 40);
}

Scene makeSmash() {
  constexpr double kSide = 0.4;
  Scene scene = sceneOf(100);
  scene.gravity = {};
  Body ram = boxOf({-20, 0}, 8, 8, 8);
  ram.velocity = {40, 0};
  scene.bodies.push_back(ram);
  for (int column = 0; column < 60; ++column) {
    for (int row = 0; row < 40; ++row) {
      scene.bodies.push_back(boxOf({30 + kSide * column, kSide * (row - 19.5)}, kSide, kSide));
    }
  }
  return scene;
}

Scene makeChain100() {
  constexpr int kLinks = 20;
  Scene scene = jointsOf(300);
  for (int i = 0; i < kLinks; ++i) {
    scene.bodies.push_back(boxOf({i + 0.5, 0}, 1, 0.25));
    scene.joints.push_back(hinge(i - 1, i, {static_cast<double>(i), 0}));  // the first is at the world
  }
  scene.bodies.push_back(boxOf({kLinks + 0.5, 0}, 1, 1, 100 * scene.bodies.front().mass));
  scene.joints.push_back(hinge(kLinks - 1, kLinks, {kLinks, 0}));
  return scene;
}

Scene makeGrid100() {
  constexpr int kSide = 100;
  Scene scene = jointsOf(30);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const int index = kSide * row + column;
      const Vec centre{static_cast<double>(column), static_cast<double>(row)};
      scene.bodies.push_back(discOf(centre, 0.4));
      if (row == 0 && column >= 47 && column < 54) scene.bodies.back().motion = Motion::FIXED;
      if (column + 1 < kSide) scene.joints.push_back(hinge(index, index + 1, centre + Vec{0.5, 0}));
      if (row + 1 < kSide) scene.joints.push_back(hinge(index, index + kSide, centre + Vec{0, 0.5}));
    }
  }
  return scene;
}

Scene makeCloth(int side, double gravity) {
  constexpr double kMesh = 1;  // side of a mesh, m
  Scene scene;
  scene.gravity = {0, -gravity};
  scene.ticks = 300;
  scene.cloths = {{side, side, kMesh, 1, 4500}};  // stiffness: 5 cells per tick²
  for (int i = 0; i < side * side; ++i) {
    scene.bodies.push_back(point({kMesh * (i % side), -kMesh * (i / side)}, {}, 1.0 / (side * side)));
    if (i == 0 || i == side - 1) scene.bodies.back().motion = Motion::FIXED;
  }
  for (int i = 0; i < side * side; ++i) {
    const Vec at = scene.bodies[static_cast<std::size_t>(i)].position;
    if (i % side + 1 < side) scene.joints.push_back(rod(i, at, i + 1, at + Vec{kMesh, 0}));
    if (i + side < side * side) scene.joints.push_back(rod(i, at, i + side, at - Vec{0, kMesh}));
  }
  return scene;
}

}  // namespace lab
