#include "BenchScene.h"

#include <cmath>

namespace lab {
namespace {

Motion motionOf(heaps::Motion motion) {
  if (motion == heaps::Motion::STATIC) return Motion::FIXED;
  return motion == heaps::Motion::KINEMATIC ? Motion::KINEMATIC : Motion::DYNAMIC;
}

Shape shapeOf(const heaps::Part& part) {
  const Vec centre{part.x, part.y};
  if (part.isCircle()) return {Shape::Kind::CIRCLE, part.radius, {}, centre};
  return {Shape::Kind::BOX, 0, {part.half_width, part.half_height}, centre};
}

Body bodyOf(const heaps::Body& body) {
  Body made;
  made.motion = motionOf(body.motion);
  made.position = {body.x, body.y};
  made.velocity = {body.vx, body.vy};
  made.spin = body.spin;
  made.mass = body.mass();
  made.rotates = true;
  made.friction = heaps::Scene::kFriction;
  for (const heaps::Part& part : body.parts) made.shapes.push_back(shapeOf(part));
  return made;
}

}  // namespace

Scene sceneOf(const heaps::Scene& scene) {
  Scene made;
  made.gravity = {0, scene.gravity};
  made.ticks = scene.ticks;
  made.may_sleep = scene.sleep;
  made.collides = scene.collide;
  made.has_full_sides = true;
  for (const heaps::Body& body : scene.bodies) made.bodies.push_back(bodyOf(body));
  for (const heaps::Hinge& joint : scene.hinges)
    made.joints.push_back(hinge(joint.a, joint.b, {joint.x, joint.y}));
  return made;
}

heaps::Pose poseOf(const BodyState& state) {
  return {state.position.x, state.position.y, std::cos(state.angle), std::sin(state.angle)};
}

std::vector<heaps::Pose> posesOf(const heaps::Scene& scene, const Simulation& simulation) {
  std::vector<heaps::Pose> poses;
  poses.reserve(scene.bodies.size());
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) poses.push_back(poseOf(simulation.body(i)));
  return poses;
}

long countLost(const heaps::Scene& scene, const Simulation& simulation) {
  const std::vector<heaps::Pose> poses = posesOf(scene, simulation);
  long lost = simulation.frozen();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (scene.bodies[i].motion == heaps::Motion::DYNAMIC && !scene.room.holds(poses, poses[i])) ++lost;
  }
  return lost;
}

}  // namespace lab
