#include "Scene.h"

#include <algorithm>

namespace lab {

Body point(Vec position, Vec velocity, double mass) {
  Body body;
  body.position = position;
  body.velocity = velocity;
  body.mass = mass;
  return body;
}

Body ball(Vec position, Vec velocity, double radius, double mass) {
  Body body = point(position, velocity, mass);
  body.shapes.push_back({Shape::Kind::CIRCLE, radius, {}});
  return body;
}

Body box(Vec position, Vec half, double mass) {
  Body body = point(position, {}, mass);
  body.shapes.push_back({Shape::Kind::BOX, 0, half});
  return body;
}

Body crate(Vec position, Vec half, double friction, double mass) {
  Body body = box(position, half, mass);
  body.friction = friction;
  body.rotates = true;
  return body;
}

Body wall(Vec centre, Vec half, double angle) {
  Body body = box(centre, half);
  body.motion = Motion::FIXED;
  body.angle = angle;
  return body;
}

Body ground(double half_width, double friction, double restitution) {
  Body body = wall({0, -5}, {half_width, 5});
  body.friction = friction;
  body.restitution = restitution;
  return body;
}

double inertiaOf(const Shape& shape) {
  return shape.kind == Shape::Kind::CIRCLE ? shape.radius * shape.radius / 2
                                           : dot(shape.half, shape.half) / 3;
}

Joint rod(int a, Vec from, int b, Vec to) {
  Joint joint;
  joint.a = a;
  joint.b = b;
  joint.anchor_a = from;
  joint.anchor_b = to;
  return joint;
}

Joint spring(int a, Vec from, int b, Vec to, double stiffness) {
  Joint joint = rod(a, from, b, to);
  joint.kind = Joint::Kind::SPRING;
  joint.stiffness = stiffness;
  joint.rest_length = length(to - from);
  return joint;
}

Joint hinge(int a, int b, Vec at) {
  Joint joint = rod(a, at, b, at);
  joint.kind = Joint::Kind::HINGE;
  return joint;
}

int Scene::countDynamic() const {
  return static_cast<int>(std::ranges::count(bodies, Motion::DYNAMIC, &Body::motion));
}

}  // namespace lab
