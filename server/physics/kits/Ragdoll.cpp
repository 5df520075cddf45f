#include "physics/kits/Ragdoll.h"

#include <cmath>

#include "physics/body/PhysicsManager.h"

namespace df {

namespace {

// A part of a figure of height 1 and mass 1. x and widths are in units of the height, too; y grows downward.
struct Part {
  double x, y;
  double width, height;
  double mass;
};
constexpr Part kTrunk = {0, 0, 0.22, 0.36, 0.44};
constexpr double kHead = 0.1;  // radius, in units of the height
constexpr double kHeadMass = 0.08;
constexpr Part kUpperArm = {0.21, -0.14, 0.2, 0.07, 0.05};
constexpr Part kLowerArm = {0.41, -0.14, 0.2, 0.06, 0.04};
constexpr Part kThigh = {0.06, 0.29, 0.1, 0.22, 0.09};
constexpr Part kShin = {0.06, 0.51, 0.08, 0.22, 0.06};

class Maker {
 public:
  Maker(Vector where, double height, double mass, Color color)
      : m_where(where), m_height(height), m_mass(mass), m_color(color) {}

  Body* box(const Part& part, int side) const {
    Body* p_body = body(part.x * side, part.y, part.mass);
    p_body->setBoxShape(part.width * across(), part.height * m_height);
    return p_body;
  }
  Body* head() const {
    Body* p_body = body(0, kTrunk.y - kTrunk.height / 2 - kHead, kHeadMass);
    p_body->setCircle(kHead * across());
    return p_body;
  }
  // Adds a hinge that bends by `lower` to `upper` radians, clockwise.
  void hinge(Body* p_a, Body* p_b, double x, double y, double lower, double upper) const {
    PM.addHinge(p_a, p_b, at(x, y));
    PM.addAngleLimit(p_a, p_b, lower, upper);
  }

 private:
  double across() const { return m_height * PM.getAspect(); }  // the figure's height in cell widths
  Vector at(double x, double y) const { return m_where + Vector(x * across(), y * m_height); }
  Body* body(double x, double y, double mass) const {
    auto* p_body = new Body;
    p_body->setType("Ragdoll");
    p_body->setPosition(at(x, y));
    p_body->setMass(mass * m_mass);
    p_body->setTurning();
    p_body->setDrawing(BodyDrawing::FILL, 0, m_color);
    return p_body;
  }

  Vector m_where;
  double m_height;
  double m_mass;
  Color m_color;
};

}  // namespace

std::array<Body*, 10> Ragdoll::parts() const {
  return {p_trunk,       p_head,    upper_arms[0], upper_arms[1], lower_arms[0],
          lower_arms[1], thighs[0], thighs[1],     shins[0],      shins[1]};
}

Ragdoll makeRagdoll(Vector where, double height, double mass, Color color) {
  constexpr double kMax = 1e4;
  if (!(height > 0 && height <= kMax)) height = 8;
  if (!(mass > 0 && mass <= kMax * kMax)) mass = 8;
  const Maker make(where, height, mass, color);
  Ragdoll figure;
  figure.p_trunk = make.box(kTrunk, 1);
  figure.p_head = make.head();
  make.hinge(figure.p_trunk, figure.p_head, 0, kTrunk.y - kTrunk.height / 2, -0.6, 0.6);
  for (const std::size_t i : {0U, 1U}) {
    const int side = i == 0 ? -1 : 1;
    figure.upper_arms[i] = make.box(kUpperArm, side);
    figure.lower_arms[i] = make.box(kLowerArm, side);
    figure.thighs[i] = make.box(kThigh, side);
    figure.shins[i] = make.box(kShin, side);
    make.hinge(figure.p_trunk, figure.upper_arms[i], side * (kUpperArm.x - kUpperArm.width / 2), kUpperArm.y,
               -1.6, 1.6);
    make.hinge(figure.upper_arms[i], figure.lower_arms[i], side * (kLowerArm.x - kLowerArm.width / 2),
               kLowerArm.y, -1.5, 1.5);
    make.hinge(figure.p_trunk, figure.thighs[i], side * kThigh.x, kThigh.y - kThigh.height / 2, -1.2, 1.2);
    make.hinge(figure.thighs[i], figure.shins[i], side * kShin.x, kShin.y - kShin.height / 2, -1.3, 1.3);
  }
  return figure;
}

}  // namespace df
