#include <cmath>

#include "SoftScene.h"
#include "physics/soft/SoftForces.h"
#include "tests/support/Quad.h"

namespace naiad::physics {
namespace {

using test::kBody;
using test::kGravity;

constexpr double kPi = 3.14159265358979323846;
// A beam with times in ticks: EI 14, EA 3e3, mass 25 per length, length 10. Its first mode takes about 240
// ticks.
constexpr double kEi = 14, kEa = 3e3, kDensity = 25, kLength = 10;

SoftBody clamped(int elements) {
  return makeBeam({}, {kLength, 0}, elements, kEi, kEa, kDensity, true);
}

// Bends the beam by a ten-thousandth of its length, for which the linear theory is right to 1e-8.
double relativeDeflection(int elements) {
  SoftBody beam = clamped(elements);
  beam.drag = 0.1;
  const double expected = 0.001, force = expected * 3 * kEi / (kLength * kLength * kLength);
  beam.nodes.back().force = {0, force};
  SoftWorld world = test::worldWith(beam, 0, 1);
  for (int i = 0; i < 3000; ++i) world.step();
  EXPECT_LT(test::fastest(world.body(kBody)), 1e-12);
  return test::nodeAt(world, kBody, elements).y / expected - 1;
}

// Problem 11b of docs/physics/lab.md: FL³/3EI within 1 %. The error is proportional to elements^−3.
TEST(SoftBody, CantileverBendsByTheFormula) {
  const double coarse = relativeDeflection(8), medium = relativeDeflection(16), fine = relativeDeflection(32);
  EXPECT_LT(std::fabs(coarse), 1e-3);
  EXPECT_LT(std::fabs(fine), 1e-5);
  EXPECT_NEAR(coarse / medium, 8, 1);
  EXPECT_NEAR(medium / fine, 8, 1);
}

// The beam starts in the shape of the first mode; measures the time between its passages through the middle.
double relativeFrequency(int elements, int substeps) {
  const double beta = 1.8751040687119612,
               sigma = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
  SoftBody beam = clamped(elements);
  for (SoftNode& node : beam.nodes) {
    const double x = beta * node.offset.x / kLength;
    node.offset.y = 0.01 * (std::cosh(x) - std::cos(x) - sigma * (std::sinh(x) - std::sin(x)));
  }
  SoftWorld world = test::worldWith(beam, 0, substeps);
  double before = 1, first = 0, last = 0;
  int passages = 0;
  for (int i = 0; i < 1200; ++i) {
    world.step();
    const double now = test::nodeAt(world, kBody, elements).y;
    if ((now < 0) != (before < 0)) {
      last = i + 1 - now / (now - before);
      if (passages++ == 0) first = last;
    }
    before = now;
  }
  const double measured = (passages - 1) / (2 * (last - first));
  const double expected = beta * beta / (2 * kPi) * std::sqrt(kEi / kDensity / std::pow(kLength, 4));
  return measured / expected - 1;
}

// Problem 11b: f₁ within 1 %, and an error of second order.
TEST(SoftBody, CantileverSwingsAtItsFirstFrequency) {
  EXPECT_LT(std::fabs(relativeFrequency(4, 4)), 0.01);
  EXPECT_LT(std::fabs(relativeFrequency(8, 4)), 1e-3);
  EXPECT_LT(std::fabs(relativeFrequency(8, 1)), 1e-3);
  const double medium = relativeFrequency(32, 16), fine = relativeFrequency(64, 16);
  EXPECT_LT(std::fabs(medium), 1e-4);
  EXPECT_NEAR(medium / fine, 4, 0.5);
}

double relativeSag(int links) {
  constexpr double kSpan = 10, kRope = 12;
  Quad a = kSpan / 2;  // y = a cosh(x/a)
  for (int i = 0; i < 200; ++i) {
    const Quad u = Quad(kSpan) / 2 / a;
    const Quad sinh_u = sinhq(u), cosh_u = coshq(u);
    a -= (2 * a * sinh_u - kRope) / (2 * sinh_u - 2 * u * cosh_u);
  }
  const double sag = static_cast<double>(a * (coshq(Quad(kSpan) / 2 / a) - 1));
  SoftBody rope = makeRope({}, {kRope, 0}, links, kRope, 1e6);
  const double depth = std::sqrt(kRope * kRope - kSpan * kSpan) / 2;
  for (int i = 0; i <= links; ++i) {
    const double part = 2.0 * i / links;
    rope.nodes[static_cast<std::size_t>(i)].offset = {kSpan / 2 * part, depth * std::min(part, 2 - part)};
  }
  rope.nodes.front().is_pinned = rope.nodes.back().is_pinned = true;
  rope.drag = 0.1;
  SoftWorld world = test::worldWith(rope, kGravity);
  for (int i = 0; i < 600; ++i) world.step();
  return test::nodeAt(world, kBody, links / 2).y / sag - 1;
}

// Problem 11b.
TEST(SoftBody, RopeHangsAsACatenary) {
  const double coarse = relativeSag(16), medium = relativeSag(32), fine = relativeSag(64);
  EXPECT_LT(std::fabs(coarse), 0.01);
  EXPECT_LT(std::fabs(fine), 0.001);
  EXPECT_NEAR(coarse / medium, 4, 0.3);
  EXPECT_NEAR(medium / fine, 4, 0.3);
}

// A ring under pressure: tension = pressure · radius (times the polygon's cosine) = EA · strain.
TEST(SoftBody, BlobSwellsToTheSkinPressureBalance) {
  constexpr int kNodes = 24;
  constexpr double kRadius = 2, kSkin = 1, kPressure = 0.1;
  SoftBody blob = makeBlob({}, kRadius, kNodes, 5, kPressure, 0, kSkin);
  blob.drag = 0.1;
  SoftWorld world = test::worldWith(blob);
  for (int i = 0; i < 2000; ++i) world.step();
  const double expected = kSkin / (kSkin / kRadius - kPressure * std::cos(kPi / kNodes));
  EXPECT_NEAR(length(test::nodeAt(world, kBody, 0) - test::centreOf(world, kBody)), expected, 1e-9);
}

double springError(int substeps) {
  SoftBody pair = makeRope({}, {1, 0}, 1, 2, 0.01);  // a mass of 1 on a spring of stiffness 0.01: ω = 0.1
  pair.nodes[0].is_pinned = true;
  pair.nodes[1].offset.x = 1.1;
  SoftWorld world = test::worldWith(pair, 0, substeps);
  double most = 0;
  for (int i = 1; i <= 200; ++i) {
    world.step();
    most = std::max(most, std::fabs(test::nodeAt(world, kBody, 1).x - 1 - 0.1 * std::cos(0.1 * i)));
  }
  return most / 0.1;
}

TEST(SoftBody, StepConvergesWithSecondOrder) {
  const double coarse = springError(8), medium = springError(16), fine = springError(32);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(coarse / medium, 4, 0.4);
  EXPECT_NEAR(medium / fine, 4, 0.4);
}

// Energy does not grow and nothing is thrown, at any stiffness up to 1e10 (also of beams) and step up to 100
// ticks.
TEST(SoftBody, EnergyNeverGrowsAtAnyStiffnessOrStep) {
  for (const double stiffness : {1e-3, 1.0, 1e3, 1e6, 1e10}) {
    for (const double dt : {0.1, 1.0, 10.0, 100.0}) {
      SoftBody rope = makeRope({}, {10, 0}, 20, 10, stiffness, 1e-3 * stiffness);
      rope.nodes[0].is_pinned = true;
      rope.nodes.back().velocity = {0, -0.5};
      const Vec2 gravity = {0, kGravity};
      SoftWorld world = test::worldWith(rope, kGravity);
      const double before = energyOf(rope, gravity);
      double most = before;
      for (int i = 0; i < 100; ++i) {
        ASSERT_EQ(world.step(dt), SoftStatus::kDone);
        most = std::max(most, energyOf(world.body(kBody), gravity));
      }
      EXPECT_LT(most, before + 1e-8) << stiffness << ' ' << dt;
      EXPECT_LT(length(test::nodeAt(world, kBody, 20)), 10.1 + 20 / stiffness) << stiffness << ' ' << dt;
      EXPECT_LT(length(test::nodeAt(world, kBody, 1)), 0.6 + 20 / stiffness) << stiffness << ' ' << dt;
    }
  }
}

// Links of stiffness 1e10 keep their length under any load: to 2e-12 per unit of weight, and to about ten
// times that after a jerk.
TEST(SoftBody, StiffRopeKeepsItsLength) {
  for (const double end : {1.0, 1e3, 1e6}) {
    SoftBody rope = makeRope({}, {10, 0}, 20, 20, 0.5e10);
    rope.nodes[0].is_pinned = true;
    rope.nodes.back().mass = end;
    SoftWorld world = test::worldWith(rope, kGravity);
    double stretch = 0;
    for (int i = 0; i < 300; ++i) {
      world.step();
      for (const SoftStretch& s : world.body(kBody).stretches) {
        stretch = std::max(stretch, std::fabs(spanOf(world.body(kBody), s).length / s.rest_length - 1));
      }
    }
    EXPECT_LT(stretch, 2e-9 + 3e-11 * end) << end;
    EXPECT_EQ(world.counters().unconverged, 0) << end;
  }
}

}  // namespace
}  // namespace naiad::physics
