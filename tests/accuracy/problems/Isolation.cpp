// Problem 23: a group of bodies must move exactly alike alone and with another group far away.
#include <string>
#include <vector>

#include "Path.h"

namespace lab {
namespace {

constexpr double kFar = 2000;  // m between the groups
constexpr int kTicks = 200;
constexpr Vec kHalf{0.5, 0.25};

enum class Held { ROD, SPRING, NOTHING };

// Adds two boxes that fall onto a floor. One of them rotates.
void addPair(Scene& scene, Held held, Vec at, Vec velocity) {
  const int first = static_cast<int>(scene.bodies.size());
  for (int i = 0; i < 2; ++i) {
    Body made = crate(at + Vec{1.5 * i, 0.1 * i}, kHalf, 0.6);
    made.velocity = velocity;
    made.spin = i;
    scene.bodies.push_back(made);
  }
  if (held == Held::NOTHING) return;
  const Vec from = at + Vec{0.5, 0}, to = at + Vec{1, 0.1};
  scene.joints.push_back(held == Held::SPRING ? spring(first, from, first + 1, to, 300)
                                              : rod(first, from, first + 1, to));
}

void addFloor(Scene& scene, double x) {
  scene.bodies.push_back(ground(100, 0.6));
  scene.bodies.back().position.x = x;
}

Scene alone(Held held) {
  Scene scene;
  scene.gravity = {0, -10};
  scene.ticks = kTicks;
  scene.may_sleep = true;  // one group may sleep while the other moves
  addPair(scene, held, {0, 3}, {1, 0});
  addFloor(scene, 0);
  return scene;
}

// Adds another group far away, which rests, flies, or lies on its own floor.
Scene accompanied(Held held, double speed, bool has_floor) {
  Scene scene = alone(held);
  addPair(scene, held, {kFar, has_floor ? 0.25 : 3.0}, {0, speed});
  if (has_floor) addFloor(scene, kFar);
  return scene;
}

bool areEqual(const BodyState& a, const BodyState& b) {
  return a.position.x == b.position.x && a.position.y == b.position.y && a.velocity.x == b.velocity.x &&
         a.velocity.y == b.velocity.y && a.angle == b.angle && a.spin == b.spin;
}

Case heldBy(Held held, const std::string& name) {
  Case beside(name, held == Held::NOTHING ? "two boxes" : "two boxes on a " + name,
              accompanied(held, 30, false));
  beside.most_substeps = 16;
  beside.metrics = {{"differing", "part of the ticks in which a bit differs", 0, 1e-6, 0}};
  beside.judge = [held](const Trial& trial) {
    std::vector<BodyState> path;
    trial.run(alone(held), [&](int /*tick*/, const Simulation& simulation) {
      path.push_back(simulation.body(0));
      path.push_back(simulation.body(1));
    });
    int differing = 0, ticks = 0;
    for (const double speed : {0.0, 0.3, 30.0, 3e4}) {
      for (const bool has_floor : {false, true}) {
        std::size_t next = 0;
        trial.run(accompanied(held, speed, has_floor), [&](int /*tick*/, const Simulation& simulation) {
          const bool same =
              areEqual(simulation.body(0), path[next]) && areEqual(simulation.body(1), path[next + 1]);
          next += 2;
          ++ticks;
          if (!same) ++differing;
        });
      }
    }
    return std::vector<double>{static_cast<double>(differing) / ticks};
  };
  return beside;
}

// Two boxes on a rod, on a spring, or on nothing fall onto a floor, alone and with another such pair 2000 m
// away that rests, moves by 0.01 to 1000 cells a tick, or lies on a floor of its own; 200 ticks. What rests
// may sleep. Correct: no bit differs from the run alone.
std::vector<Case> make() {
  return {heldBy(Held::ROD, "rod"), heldBy(Held::SPRING, "spring"), heldBy(Held::NOTHING, "loose")};
}

const RegisteredProblem problem("23", "isolation", make, "Groups do not see each other",
                                "What happens at one end of a world must not change a bit at its other end.");

}  // namespace
}  // namespace lab
