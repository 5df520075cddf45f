#include "SpringScene.h"

namespace lab {

Scene springScene(const SpringLine& system, int ticks) {
  Scene scene;
  const Vec position = (system.rest_length + system.offset) * system.direction;
  scene.bodies = {point(position)};
  scene.joints = {spring(-1, {}, 0, position, system.stiffness)};
  scene.joints[0].damping = system.damping;
  scene.joints[0].rest_length = system.rest_length;
  scene.gravity = system.gravity * system.direction;
  scene.ticks = ticks;
  scene.equations = equationsOf(system);
  return scene;
}

Quad springOffset(const SpringLine& system, Quad t) {
  const Quad rest = Quad(system.gravity) / system.stiffness;
  const Quad start = system.offset - rest;
  const Quad decay = Quad(system.damping) / 2;
  const Quad square = Quad(system.stiffness) - decay * decay;
  Quad part = 0;
  if (square > 0) {
    const Quad omega = sqrt(square);
    part = exp(-decay * t) * (cos(omega * t) + decay / omega * sin(omega * t));
  } else if (square == 0) {
    part = exp(-decay * t) * (1 + decay * t);
  } else {
    const Quad root = sqrt(-square);
    const Quad slow = system.stiffness / (decay + root);  // decay − root without cancellation
    const Quad fast = decay + root;
    part = (fast * exp(-slow * t) - slow * exp(-fast * t)) / (2 * root);
  }
  return rest + start * part;
}

}  // namespace lab
