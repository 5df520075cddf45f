#include "Things.h"

#include "DisplayManager.h"
#include "SoftObject.h"

namespace {

/// A beam, a rail: HARD and without mass, so bodies bounce off it.
class Wall : public df::Object {
 public:
  Wall(df::Vector corner, double width, double height) {
    setType("Wall");
    setStaticLook();
    setPosition(corner);
    setBox(df::Box(df::Vector(-0.5, -0.5), width, height));
  }
  int draw() override {
    const df::Box box = getBox();
    for (int y = 0; y < box.getVertical(); ++y)
      for (int x = 0; x < box.getHorizontal(); ++x)
        DM.drawCh(getPosition() + df::Vector(x, y), '%', df::BLUE);
    return 0;
  }
};

}  // namespace

Thing::Thing(df::Vector where) {
  setType("Thing");
  setPosition(where);
  setTurning();
  setFriction(0.6);
  setDrag(0.001);
}

Crate::Crate(df::Vector where, df::Color color, double width, double height) : Thing(where) {
  setBoxShape(width, height);
  setMass(width * height / 8);
  setDrawing(df::BodyDrawing::FILL, '#', color);
}

Ball::Ball(df::Vector where, df::Color color, double radius, double restitution) : Thing(where) {
  setCircle(radius);
  setMass(radius * radius / 2.5);
  setRestitution(restitution);
  setDrawing(df::BodyDrawing::FILL, 'o', color);
}

void makePyramid(df::Vector foot, int rows) {
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      new Crate(foot + df::Vector(4.2 * i + 2.1 * row, -1 - 2 * row), row % 2 == 0 ? df::YELLOW : df::RED);
}

void makeBridge(df::Vector left, df::Vector right, int planks) {
  const df::Vector way = right - left;
  const double length = way.x() / planks;
  df::Body* p_before = nullptr;
  for (int i = 0; i < planks; ++i) {
    auto* p_plank = new Crate(left + df::Vector(length * (i + 0.5), way.y() * (i + 0.5) / planks), df::CYAN,
                              length - 0.4, 0.9);
    p_plank->setMass(1);
    PM.addHinge(p_before, p_plank, left + df::Vector(length * i, way.y() * i / planks));
    p_before = p_plank;
  }
  PM.addHinge(p_before, nullptr, right);
}

void makeCradle(df::Vector where, int balls) {
  constexpr double kRadius = 1.5;
  constexpr double kRod = 5;  // rows
  for (int i = 0; i < balls; ++i) {
    const df::Vector above = where + df::Vector(2 * kRadius * i, 0);
    auto* p_ball =
        new Ball(above + (i == 0 ? df::Vector(-2 * kRod, 0) : df::Vector(0, kRod)), df::MAGENTA, kRadius, 1);
    p_ball->setTurning(false);
    p_ball->setFriction(0);
    p_ball->setDrag(0);
    PM.addDistance(nullptr, p_ball, above, p_ball->getPosition());
  }
}

void makeBilliard(df::Vector corner, double width, double height) {
  makeWall(corner, width, 1);
  makeWall(corner + df::Vector(0, height - 1), width, 1);
  makeWall(corner, 1, height);
  makeWall(corner + df::Vector(width - 1, 0), 1, height);
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i <= row; ++i) {
      const df::Vector at(width / 2 + 3 * row, height / 2 + (i - row / 2.0) * 1.6);
      auto* p_ball = new Ball(corner + at, df::GREEN, 1.4, 0.95);
      p_ball->setGravityScale(0);
      p_ball->setDrag(0.01);
    }
  }
}

void makeBlob(df::Vector where, df::Color color) {
  auto* p_blob = new df::Blob(where, 2.5);
  p_blob->setDrawing(df::BodyDrawing::FILL, 'o', color);
}

void makeFlag(df::Vector corner, double width, double height) {
  auto* p_flag = new df::Cloth(corner, width, height, 0.5);
  p_flag->setDrawing(df::BodyDrawing::FILL, ':', df::RED);
  for (int row = 0; row < p_flag->getRows(); ++row) p_flag->pin(p_flag->getNode(0, row));
}

void makeWall(df::Vector corner, double width, double height) {
  new Wall(corner, width, height);
}
