#include "Scene.h"

namespace lab {

Body ball(Vec position, Vec velocity, double radius, double mass) {
  Body body;
  body.position = position;
  body.velocity = velocity;
  body.mass = mass;
  body.shapes.push_back({Shape::Kind::CIRCLE, radius, {}});
  return body;
}

Body box(Vec position, Vec half, double mass) {
  Body body;
  body.position = position;
  body.mass = mass;
  body.shapes.push_back({Shape::Kind::BOX, 0, half});
  return body;
}

Body wall(Vec centre, Vec half, double angle) {
  Body body = box(centre, half);
  body.motion = Motion::FIXED;
  body.angle = angle;
  return body;
}

Joint rod(int a, Vec from, int b, Vec to) {
  Joint joint;
  joint.a = a;
  joint.b = b;
  joint.anchor_a = from;
  joint.anchor_b = to;
  return joint;
}

Joint hinge(int a, int b, Vec at) {
  Joint joint = rod(a, at, b, at);
  joint.kind = Joint::Kind::HINGE;
  return joint;
}

}  // namespace lab
