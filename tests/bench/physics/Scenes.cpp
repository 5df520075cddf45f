#include "Scenes.h"

#include <cmath>
#include <numbers>
#include <random>

namespace bench::physics {
namespace {

// Makes a box from the lengths of its sides.
Body box(double x, double y, double width, double height, Motion motion = Motion::DYNAMIC) {
  Body body;
  body.parts.push_back({.half_width = width / 2, .half_height = height / 2});
  body.x = x;
  body.y = y;
  body.motion = motion;
  return body;
}

Body circle(double x, double y, double radius) {
  Body body;
  body.parts.push_back({.radius = radius});
  body.x = x;
  body.y = y;
  return body;
}

// Adds a floor with its top at y = 0.
void addFloor(Scene& scene, double centre, double width) {
  scene.bodies.push_back(box(centre, 0.5, width, 1, Motion::STATIC));
  scene.room.bottom = 0;
}

void addPyramid(Scene& scene, double centre, int rows) {
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < rows - row; ++i) {
      scene.bodies.push_back(box(centre + i - 0.5 * (rows - row - 1), -0.5 - row, 1, 1));
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

Body heapBody(int index, double x, double y) {
  if (index % 3 == 0) return circle(x, y, 0.5);
  return box(x, y, 1, index % 3 == 1 ? 1 : 0.6);
}

Scene makeHeap(int count, int ticks) {
  constexpr double kPitch = 1.3;
  Scene scene;
  scene.ticks = ticks;
  const double half = inWholeUnits(0.8 * std::sqrt(count));
  const int columns = static_cast<int>(2 * half / kPitch);
  const int rows = (count + columns - 1) / columns;
  const double height = 2 * std::ceil(kPitch * rows / 2) + 10;
  addFloor(scene, 0, 2 * half + 4);
  scene.bodies.push_back(box(-half - 0.5, -height / 2, 1, height, Motion::STATIC));
  scene.bodies.push_back(box(half + 0.5, -height / 2, 1, height, Motion::STATIC));
  scene.room.left = -half;
  scene.room.right = half;
  Shift shift;
  for (int i = 0; i < count; ++i) {
    const double x = -half + 0.7 + kPitch * (i % columns) + shift.next();
    const double y = -1 - kPitch * (i / columns) + shift.next();
    scene.bodies.push_back(heapBody(i, x, y));
  }
  return scene;
}

}  // namespace

Scene makePyramid60() {
  Scene scene;
  scene.ticks = 14;
  addFloor(scene, 0, 160);
  addPyramid(scene, 0, 60);
  return scene;
}

Scene makePyramids100() {
  Scene scene;
  scene.ticks = 14;
  for (int i = 0; i < 100; ++i) {
    addFloor(scene, 16 * i, 14);
    addPyramid(scene, 16 * i, 10);
  }
  return scene;
}

Scene makeTumbler500() {
  constexpr double kInside = 9.5;
  Scene scene;
  scene.ticks = 150;
  Body drum;
  drum.motion = Motion::KINEMATIC;
  drum.spin = 25 * std::numbers::pi / 180;
  drum.parts = {{.half_width = 10, .half_height = 0.5, .y = -10},
                {.half_width = 10, .half_height = 0.5, .y = 10},
                {.half_width = 0.5, .half_height = 10, .x = -10},
                {.half_width = 0.5, .half_height = 10, .x = 10}};
  scene.bodies.push_back(drum);
  scene.room = {.left = -kInside, .right = kInside, .top = -kInside, .bottom = kInside, .frame = 0};
  for (int i = 0; i < 500; ++i) {
    const int column = i % 23;
    const int row = i / 23;
    scene.bodies.push_back(box(0.4 * (column - 11), 0.4 * (row - 10.5), 0.25, 0.25));
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
  Scene scene;
  scene.ticks = 100;
  scene.gravity = 0;
  Body ram = box(-20, 0, 8, 8);
  ram.vx = 40;
  ram.density = 8;
  scene.bodies.push_back(ram);
  for (int column = 0; column < 60; ++column) {
    for (int row = 0; row < 40; ++row) {
      scene.bodies.push_back(box(30 + kSide * column, kSide * (row - 19.5), kSide, kSide));
    }
  }
  return scene;
}

Scene makeChain100() {
  constexpr int kLinks = 20;
  Scene scene;
  scene.ticks = 300;
  scene.sleep = false;
  scene.collide = false;
  for (int i = 0; i < kLinks; ++i) {
    scene.bodies.push_back(box(i + 0.5, 0, 1, 0.25));
    scene.hinges.push_back({i - 1, i, static_cast<double>(i), 0});  // the first is at the world
  }
  Body load = box(kLinks + 0.5, 0, 1, 1);
  load.density = 100 * scene.bodies.front().mass();
  scene.bodies.push_back(load);
  scene.hinges.push_back({kLinks - 1, kLinks, kLinks, 0});
  return scene;
}

Scene makeGrid100() {
  constexpr int kSide = 100;
  Scene scene;
  scene.ticks = 30;
  scene.sleep = false;
  scene.collide = false;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const int index = kSide * row + column;
      Body disc = circle(column, row, 0.4);
      if (row == 0 && column >= 47 && column < 54) disc.motion = Motion::STATIC;
      scene.bodies.push_back(disc);
      if (column + 1 < kSide)
        scene.hinges.push_back({index, index + 1, column + 0.5, static_cast<double>(row)});
      if (row + 1 < kSide) {
        scene.hinges.push_back({index, index + kSide, static_cast<double>(column), row + 0.5});
      }
    }
  }
  return scene;
}

}  // namespace bench::physics
