// Groups that do not touch have no effect on each other. Two jointed bodies move identically, bit for bit,
// alone and with another pair far away that moves in any way.
#include <algorithm>
#include <array>
#include <tuple>

#include "tests/server/physics/BodyScene.h"
#include "tests/server/physics/SceneRandom.h"

namespace df::test {
namespace {

constexpr int kTicks = 200;
// Returns the cells between the pairs. If the other pair could come near in a tick, one solver would have to
// move both.
double farFor(double speed) {
  return std::max(2000.0, 10 * speed);
}

enum class Link { kDistance, kRope, kHinge, kSpring, kNone };
constexpr std::array<const char*, 5> kLinkNames = {"Distance", "Rope", "Hinge", "Spring", "None"};
enum class Added { kBefore, kAfter, kMidway };
constexpr std::array<const char*, 3> kAddedNames = {"Before", "After", "Midway"};

constexpr double kOnAFloor = -1, kOnTheFloor = -2, kNobody = -3;  // codes that replace the other pair's speed

struct Pair {
  Body* p_a = nullptr;
  Body* p_b = nullptr;
};

Body* slab(Vector place, double width, double angle) {
  Body* p_slab = BodyScene::crate(place, Vector(0.5 * width, 0.2));
  p_slab->setTurning();
  p_slab->setAngle(angle);
  p_slab->setRestitution(0.2);
  return p_slab;
}

Pair pairAt(Vector place, Link link) {
  const Pair pair = {slab(place, 1.2, 0.3), slab(place + Vector(2, -0.5), 0.8, -0.2)};
  if (link == Link::kDistance) PM.addDistance(pair.p_a, pair.p_b);
  if (link == Link::kRope) PM.addRope(pair.p_a, pair.p_b);
  if (link == Link::kHinge) PM.addHinge(pair.p_a, pair.p_b, place + Vector(1, -0.2));
  if (link == Link::kSpring) PM.addSpring(pair.p_a, pair.p_b, 0.1, 0.01);
  return pair;
}

struct Others {
  Link link = Link::kDistance;
  double speed = kNobody;
  Added added = Added::kAfter;
  bool is_removed = false;
  bool takes_off = false;
};

Pair addOthers(const Others& others) {
  const bool is_on_floor = others.speed == kOnAFloor || others.speed == kOnTheFloor;
  const double far = farFor(others.speed);
  if (others.speed == kOnAFloor) BodyScene::wall(Vector(far, 5), Vector(100, 5));
  const Pair pair = pairAt(Vector(far, is_on_floor ? -1.5 : -500), others.link);
  for (Body* p_body : {pair.p_a, pair.p_b}) {
    if (!is_on_floor) p_body->setGravityScale(0);
    if (others.speed > 0) p_body->setVelocity(Vector(0.6 * others.speed, -0.8 * others.speed));
  }
  return pair;
}

// The pairs reach a shared floor in different ticks, because the watched pair falls from a larger height.
std::vector<BodyBits> bitsOf(Link link, const Others& others, bool shares_floor = false) {
  OwnWorld own(1, perSecondSquared(Vector(0, 10)));
  const bool has_others = others.speed != kNobody;
  Pair far;
  if (has_others && others.added == Added::kBefore) far = addOthers(others);
  BodyScene::wall(Vector(0, 5), Vector(shares_floor ? 5000 : 100, 5));
  const Pair pair = pairAt(Vector(0, shares_floor ? -30 : -2), link);
  if (shares_floor) pair.p_b->setSpin(0.03);  // so that its joint pulls while it falls
  if (has_others && others.added == Added::kAfter) far = addOthers(others);
  return own.states(kTicks, {pair.p_a, pair.p_b}, [&](int tick) {
    if (has_others && others.added == Added::kMidway && tick == 20) far = addOthers(others);
    if (others.is_removed && tick == 35) {
      WM.markForDelete(far.p_a);
      WM.markForDelete(far.p_b);
    }
    if (others.takes_off && tick == 30) {
      for (Body* p_body : {far.p_a, far.p_b}) p_body->setVelocity(Vector(0, -1));
    }
  });
}

class BodyIsolation : public testing::TestWithParam<std::tuple<Link, Link>> {};

TEST_P(BodyIsolation, PairMovesTheSameAloneAndBesideAnother) {
  const auto [link, other_link] = GetParam();
  for (const double speed : {kOnTheFloor, kOnAFloor, 0.0, 0.01, 0.3, 10.0, 1e3, 1e5}) {
    const bool is_shared = speed == kOnTheFloor;
    const std::vector<BodyBits> alone = bitsOf(link, {}, is_shared);
    for (const Added added : {Added::kBefore, Added::kAfter, Added::kMidway}) {
      for (const bool is_removed : {false, true}) {
        const std::vector<BodyBits> beside = bitsOf(link, {other_link, speed, added, is_removed}, is_shared);
        const auto end = std::mismatch(alone.begin(), alone.end(), beside.begin()).first;
        const auto first = static_cast<std::size_t>(end - alone.begin());
        EXPECT_EQ(first, alone.size())
            << "from tick " << first / 2 << ": the other at speed " << speed << ", added "
            << kAddedNames[static_cast<std::size_t>(added)] << (is_removed ? ", removed" : "");
      }
    }
  }
}

// The other pair changes its solver when it leaves the floor. Then all jointed bodies are collected again.
TEST_P(BodyIsolation, AirbornePairMovesTheSameWhenAnotherTakesOff) {
  const auto [link, other_link] = GetParam();
  const Others others = {other_link, kOnTheFloor, Added::kBefore, false, true};
  EXPECT_EQ(bitsOf(link, {}, true), bitsOf(link, others, true));
}

// Bounces twelve crates, whose solver changes while they are in the air. Far away others bounce, or fly past.
std::vector<BodyBits> crateBits(int others, Added added, double speed) {
  OwnWorld own(1, Vector(0, 0.01));
  naiad::physics::test::SceneRandom random;
  const auto addCrates = [](double x, int count, double step, double drop, auto& random_number) {
    BodyScene::wall(Vector(x, 0.5), Vector(50, 0.5));
    std::vector<Body*> crates;
    for (int i = 0; i < count; ++i) {
      const Vector place(x + step * (i % 4) + random_number(), -0.8 - 2 * (i / 4) - drop * random_number());
      crates.push_back(BodyScene::turningCrate(place));
      crates.back()->setRestitution(0.5);
      crates.back()->setAngle(0.3 * random_number());
    }
    return crates;
  };
  const auto addFar = [&] {
    naiad::physics::test::SceneRandom far_random{7};
    for (Body* p_body : addCrates(2000, others, 1.4, 3, far_random)) p_body->setVelocity(Vector(speed, 0));
  };
  if (added == Added::kBefore) addFar();
  const std::vector<Body*> crates = addCrates(0, 12, 2.5, 2, random);
  if (added == Added::kAfter) addFar();
  return own.states(80, crates);
}

TEST(BodyIsolationOfCrates, CratesDoNotDependOnWhichGroupCameFirst) {
  const std::vector<BodyBits> alone = crateBits(0, Added::kAfter, 0);
  for (const int others : {1, 5, 12}) {
    for (const double speed : {0.0, 1000.0}) {
      EXPECT_EQ(crateBits(others, Added::kBefore, speed), alone) << others << " at " << speed;
      EXPECT_EQ(crateBits(others, Added::kAfter, speed), alone) << others << " at " << speed;
    }
  }
}

// The game changes all bodies in one tick. A group starts again without known impulses if it is small,
// whatever else was changed.
TEST(BodyIsolationOfChanges, ChangedStackMovesTheSameBesideManyChangedBodies) {
  const auto bitsBeside = [](int pairs) {
    OwnWorld own;
    std::vector<Body*> changed;
    for (int i = 0; i < pairs; ++i) {
      for (const double y : {0.0, 1.0}) {
        changed.push_back(BodyScene::turningCrate(Vector(3000 + 3 * i, y)));
        changed.back()->setGravityScale(0);
      }
    }
    PM.setGravity(Vector(0, 0.01));
    BodyScene::wall(Vector(0, 5), Vector(50, 5));
    const Pair stack = {BodyScene::turningCrate(Vector(0, -0.5)), BodyScene::turningCrate(Vector(0.3, -1.5))};
    changed.push_back(stack.p_b);
    return own.states(30, {stack.p_a, stack.p_b}, [&](int tick) {
      if (tick != 20) return;
      for (Body* p_body : changed) p_body->setVelocity(Vector(0.01, 0));
    });
  };
  EXPECT_EQ(bitsBeside(600), bitsBeside(0));
}

// A platform does not connect the groups on it. When it moves off, each of them starts again by itself.
TEST(BodyIsolationOfChanges, StackMovesTheSameBesideOthersOnAPlatform) {
  const auto bitsBeside = [](int others) {
    OwnWorld own(1, Vector(0, 0.01));
    Body* p_platform = BodyScene::crate(Vector(0, 0.5), Vector(100, 0.5));
    p_platform->setKinematic();
    std::vector<Body*> stack;
    for (int i = 0; i <= others; ++i) {
      for (const double y : {-0.5, -1.5, -2.5}) {
        Body* p_crate = BodyScene::turningCrate(Vector(20 * i + 0.2 * y, y));
        if (i == 0) stack.push_back(p_crate);
      }
    }
    return own.states(40, stack, [&](int tick) {
      if (tick == 20) p_platform->setVelocity(Vector(0.05, -0.02));
    });
  };
  EXPECT_EQ(bitsBeside(3), bitsBeside(0));
}

INSTANTIATE_TEST_SUITE_P(Joints, BodyIsolation,
                         testing::Combine(testing::Values(Link::kDistance, Link::kRope, Link::kHinge,
                                                          Link::kSpring, Link::kNone),
                                          testing::Values(Link::kDistance, Link::kHinge, Link::kNone)),
                         [](const auto& its) {
                           return std::string(kLinkNames[static_cast<std::size_t>(std::get<0>(its.param))]) +
                                  "Beside" + kLinkNames[static_cast<std::size_t>(std::get<1>(its.param))];
                         });

}  // namespace
}  // namespace df::test
