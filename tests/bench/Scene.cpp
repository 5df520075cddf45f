#include "Scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "shared/values/SplitMix64.h"

namespace bench {
namespace {

using naiad::SplitMix64;

constexpr double kMovingPart = 0.01;  // share of moving boxes in REST

void chooseKind(Body& body, Mix mix, SplitMix64& random) {
  if (mix == Mix::MOVING) body.solidness = df::SPECTRAL;
  if (mix != Mix::MIXED && mix != Mix::SPRITES) return;
  const std::uint64_t kind = random.below(10);
  body.solidness = kind < 6 ? df::HARD : kind < 9 ? df::SOFT : df::SPECTRAL;
  if (mix == Mix::MIXED) return;
  body.width = 1 + static_cast<int>(random.below(12));
  body.height = 1 + static_cast<int>(random.below(4));
}

// True if this velocity equals its length times its direction in the float arithmetic of the Dragonfly book.
bool survivesBook(double x, double y) {
  const auto fx = static_cast<float>(x);
  const auto fy = static_cast<float>(y);
  const float speed = std::sqrt(fx * fx + fy * fy);
  return fx / speed * speed == fx && fy / speed * speed == fy;
}

void chooseVelocity(Body& body, double grain, SplitMix64& random) {
  do {
    const double speed = 1 - random.unit();
    const double angle = 2 * std::numbers::pi * random.unit();
    body.vx = std::nearbyint(speed * std::cos(angle) / grain) * grain;
    body.vy = std::nearbyint(speed * std::sin(angle) / grain) * grain;
  } while (!body.moves() || !survivesBook(body.vx, body.vy));
}

// Returns the finest grain, 2^-10 or coarser, with which the 24 bits of a float cover the world.
double grainFor(double side) {
  const int bits = std::min(10, 24 - std::ilogb(side) - 1);
  return std::ldexp(1.0, -bits);
}

// Puts the bodies on distinct random cells.
void scatter(std::vector<Body>& bodies, std::uint64_t side, SplitMix64& random) {
  std::vector<bool> taken(side * side);
  for (Body& body : bodies) {
    std::uint64_t cell = random.below(side * side);
    while (taken[cell]) cell = random.below(side * side);
    taken[cell] = true;
    const std::uint64_t row = cell / side;
    body.x = static_cast<double>(cell % side);
    body.y = static_cast<double>(row);
  }
}

// Puts the bodies on the points of a lattice, in random order.
void spread(std::vector<Body>& bodies, std::uint64_t side, SplitMix64& random) {
  const auto rows = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(bodies.size()))));
  const std::uint64_t pitch = side / rows;
  std::vector<std::uint64_t> points(bodies.size());
  std::iota(points.begin(), points.end(), 0);
  for (std::size_t i = points.size(); i > 1; --i) std::swap(points[i - 1], points[random.below(i)]);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint64_t x = points[i] % rows * pitch + pitch / 2;
    const std::uint64_t y = points[i] / rows * pitch + pitch / 2;
    bodies[i].x = static_cast<double>(x);
    bodies[i].y = static_cast<double>(y);
  }
}

}  // namespace

std::string nameOf(Mix mix) {
  constexpr const char* kNames[] = {"hard",   "mixed",       "sprites",
                                    "moving", "moving_hard", "rest"};  // in the enum's order
  return kNames[static_cast<int>(mix)];
}

Scene::Scene(Mix its_mix, int n, double its_density)
    : mix(its_mix), density(its_density), bodies(static_cast<std::size_t>(n)) {
  SplitMix64 random(20240607);
  double area = 0;
  for (Body& body : bodies) {
    chooseKind(body, mix, random);
    area += body.width * body.height;
  }
  side = std::ceil(std::sqrt(area / density));
  const double grain = grainFor(side);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const bool at_rest = mix == Mix::REST && i % static_cast<std::size_t>(1 / kMovingPart) != 0;
    if (!at_rest) chooseVelocity(bodies[i], grain, random);
  }
  if (mix == Mix::MOVING_HARD) {
    spread(bodies, static_cast<std::uint64_t>(side), random);
  } else {
    scatter(bodies, static_cast<std::uint64_t>(side), random);
  }
}

int Scene::countMoving() const {
  return static_cast<int>(std::ranges::count_if(bodies, &Body::moves));
}

}  // namespace bench
