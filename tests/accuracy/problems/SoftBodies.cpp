// Problem 11b: the catenary, and the cantilever's deflection and first frequency. Problem 28: cloths that
// hang by two corners.
#include <algorithm>
#include <complex>

#include "Path.h"
#include "Real.h"
#include "physics/Overlap.h"
#include "physics/Scenes.h"

namespace lab {
namespace {

constexpr double kGravity = 10;

// Returns a of y = a cosh(x/a) for a rope of this length between points at equal heights, by Newton's method.
double catenaryOf(double span, double its_length) {
  Quad a = span / 2;
  for (int i = 0; i < 200; ++i) {
    const Quad u = Quad(span) / 2 / a;
    const Quad sinh_u = (exp(u) - exp(-u)) / 2;
    const Quad cosh_u = (exp(u) + exp(-u)) / 2;
    a -= (2 * a * sinh_u - its_length) / (2 * sinh_u - 2 * u * cosh_u);
  }
  return static_cast<double>(a);
}

Case catenary(int links) {
  constexpr double kSpan = 10;
  constexpr double kLength = 12;
  constexpr double kDrag = 2;  // drag per mass, 1/s
  Case hanging("catenary" + std::to_string(links), "catenary of " + std::to_string(links) + " links");
  Scene& scene = hanging.scene;
  // The rope starts as a V with straight arms.
  const double depth = std::sqrt(kLength * kLength - kSpan * kSpan) / 2;
  const auto place = [&](int i) {
    const double part = 2.0 * i / links;  // 0 … 2
    return Vec{kSpan / 2 * (part - 1), -depth * std::min(part, 2 - part)};
  };
  for (int i = 1; i < links; ++i) {
    scene.bodies.push_back(point(place(i), {}, kLength / links));
    scene.bodies.back().linear_drag = kDrag * kLength / links;
    scene.joints.push_back(rod(i - 2, place(i - 1), i - 1, place(i)));
  }
  scene.joints.push_back(rod(links - 2, place(links - 1), -1, place(links)));
  scene.gravity = {0, -kGravity};
  scene.ticks = 600;
  const double a = catenaryOf(kSpan, kLength);
  const double sag = a * (std::cosh(kSpan / 2 / a) - 1);
  hanging.metrics = {{"sag", "relative error of the sag in the middle", 0.01, 0}};
  hanging.judge = atEnd(scene, [sag, links](const Simulation& end) {
    return std::abs(-end.body(links / 2 - 1).position.y / sag - 1);
  });
  return hanging;
}

// A slender beam that bends by a hundredth of its length, for which the linear theory holds to 1e-4.
Beam slender(int elements) {
  Beam beam;
  beam.length = 10;
  beam.thickness = 0.25;
  beam.modulus = 1e7;
  beam.density = 100;
  beam.elements = elements;
  return beam;
}

double stiffnessOf(const Beam& beam) {
  return beam.modulus * std::pow(beam.thickness, 3) / 12;  // bending stiffness EI, for a depth of 1 m
}

Case bending(int elements) {
  Case bent("cantilever" + std::to_string(elements),
            "cantilever of " + std::to_string(elements) + " elements");
  Beam beam = slender(elements);
  const double deflection = beam.length / 100;
  beam.tip_force = deflection * 3 * stiffnessOf(beam) / std::pow(beam.length, 3);
  beam.damping = 1;
  bent.scene.beams = {beam};
  bent.scene.ticks = 1200;
  bent.metrics = {{"deflection", "relative error of the tip's deflection", 0.01, 0}};
  bent.judge = atEnd(bent.scene, [deflection](const Simulation& end) {
    return std::abs(-end.body(0).position.y / deflection - 1);
  });
  return bent;
}

// Returns the first root of cos β cosh β = −1, by Newton's method.
Quad firstRoot() {
  Quad beta = 1.875;
  for (int i = 0; i < 20; ++i) {
    const Quad cosh_b = (exp(beta) + exp(-beta)) / 2;
    const Quad sinh_b = (exp(beta) - exp(-beta)) / 2;
    beta -= (cos(beta) * cosh_b + 1) / (cos(beta) * sinh_b - sin(beta) * cosh_b);
  }
  return beta;
}

// Returns the amplitude of `frequency` in a motion that is sampled at the ends of ticks, weighted by a window
// that fades in and out.
double presence(const std::vector<double>& motion, double tick, double frequency) {
  constexpr double kTurn = 2 * 3.14159265358979323846;
  std::complex<double> sum;
  const auto count = static_cast<double>(motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double window = 1 - std::cos(kTurn * (static_cast<double>(i) + 0.5) / count);
    sum += motion[i] * window * std::polar(1.0, -kTurn * frequency * tick * static_cast<double>(i));
  }
  return std::abs(sum);
}

// Returns the strongest frequency within a tenth of a first guess.
double strongest(const std::vector<double>& motion, double tick, double guess) {
  double low = 0.9 * guess;
  double high = 1.1 * guess;
  for (int i = 0; i < 50; ++i) {
    const double left = low + 0.382 * (high - low);
    const double right = low + 0.618 * (high - low);
    if (presence(motion, tick, left) > presence(motion, tick, right)) {
      high = right;
    } else {
      low = left;
    }
  }
  return (low + high) / 2;
}

Case ringing(int elements) {
  constexpr double kPeriods = 8;
  Case rings("frequency" + std::to_string(elements));
  Beam beam = slender(elements);
  const double deflection = beam.length / 100;
  beam.tip_force = deflection * 3 * stiffnessOf(beam) / std::pow(beam.length, 3);
  const Quad beta = firstRoot();
  const double per_length = beam.density * beam.thickness;
  const double frequency = static_cast<double>(beta * beta / (2 * kQuadPi)) *
                           std::sqrt(stiffnessOf(beam) / per_length / std::pow(beam.length, 4));
  rings.scene.beams = {beam};
  rings.scene.ticks = static_cast<int>(kPeriods / frequency / kTick);
  rings.most_substeps = 16;
  rings.metrics = {{"first", "relative error of the first frequency", 0.01, 1e-5}};
  rings.judge = [scene = rings.scene, deflection, frequency](const Trial& trial) {
    std::vector<double> motion;
    trial.run(scene, [&](int, const Simulation& simulation) {
      motion.push_back(simulation.body(0).position.y + deflection);
    });
    return std::vector<double>{std::abs(strongest(motion, scene.tick, frequency) / frequency - 1)};
  };
  return rings;
}

// A chain of 16, 32 and 64 rigid links, 12 m long, hangs between points 10 m apart: after 20 s with drag it
// is at rest. A beam of 10 m, clamped at one end, is bent by a force at the other, and swings if nothing
// damps it. Correct: a cosh(x/a), which the chain approaches with (1/links)²; FL³/3EI; the first root of cos
// β cosh β = −1.
std::vector<Case> makeSoft() {
  return {catenary(16), catenary(32), catenary(64), bending(8), bending(16),
          bending(32),  ringing(8),   ringing(16),  ringing(32)};
}

Case cloth(int side) {
  Case hung(std::to_string(side), std::to_string(side) + " × " + std::to_string(side) + " nodes",
            makeCloth(side, 18));
  hung.is_crowd = true;
  hung.long_run = side > 50;
  hung.most_substeps = side > 50 ? 4 : 16;
  hung.metrics = {{"stretch", "largest relative stretch of a thread over 10 s", 0.05, 1e-15},
                  {"frozen", "cloths that froze", 0, 0}};
  hung.judge = [scene = hung.scene](const Trial& trial) {
    return trial.largest(scene, [&](int /*tick*/, const Simulation& simulation) {
      return std::vector<double>{widestStretch(scene, statesOf(scene, simulation)),
                                 static_cast<double>(simulation.frozen())};
    });
  };
  return hung;
}

// Cloths of 25 × 25, 50 × 50 and 100 × 100 nodes with meshes of 1 m, held flat and hung by their two upper
// corners, fall for 10 s. For peers they are points on rods. Correct: no thread gets longer.
std::vector<Case> makeCloths() {
  constexpr double kDearestTick = 60'000;  // limit of the slowest tick, µs
  std::vector<Case> cases = {cloth(25), cloth(50), cloth(100)};
  cases.back().tick_bound = {.base_us = kDearestTick, .each_us = 0};
  return cases;
}

const RegisteredProblem soft_problem(
    "11b", "soft", makeSoft, "Catenary and cantilever",
    "Soft bodies have a right shape, too, and must come nearer to it with more nodes.");
const RegisteredProblem cloths(
    "28", "cloths", makeCloths, "Cloths",
    "A cloth is the stiffest thing that an author makes without thinking of it: the corners bear all of its "
    "weight, through threads of a ten-thousandth of it each.");

}  // namespace
}  // namespace lab
