// Obstacles that touch each other act as one: a body moves over tiles as over a single Object, bit by bit.
#include <functional>

#include "physics/geometry/Index.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

using BodyTiles = BodyScene;
using naiad::physics::at;

struct Push {
  double speed, force;  // per tick
};
constexpr std::array<Push, 6> kPushes = {{{.05, 0}, {.1, 0}, {.3, 0}, {.9, 0}, {1.9, 0}, {0, .02}}};

struct TileCase {
  double width = 1;
  Push push = {};
  double friction = 0;
  bool turns = false;
  Accuracy accuracy = ACCURACY_DEFAULT;
  double aspect = 1;

  std::string name() const {
    return "width " + std::to_string(width) + ", speed " + std::to_string(push.speed) + ", force " +
           std::to_string(push.force) + ", friction " + std::to_string(friction) + (turns ? ", turns" : "") +
           (accuracy == ACCURACY_FAST ? ", fast" : "") + ", aspect " + std::to_string(aspect);
  }
};

// Makes a HARD Object that covers these cells.
template <class Its = Object>
Its* block(double left, double top, double width, double height) {
  auto* p_block = new Its;
  p_block->setBox(Box(Vector(0, 0), width, height));
  p_block->setPosition(Vector(left, top));
  return p_block;
}
void tiles(double left, double top, int columns, int rows) {
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) block(left + column, top + row, 1, 1);
  }
}

using Build = std::function<void()>;
using Path = std::vector<BodyBits>;

struct TileScene {
  Build build;
  Vector start, gravity = Vector(0, .01), along = Vector(1, 0);
  double height = 1;
  int ticks = 40;
};

// Moves a box over obstacles, to which gravity presses it.
Path pathOver(const TileScene& scene, const TileCase& its) {
  OwnWorld own(its.aspect, scene.gravity, its.accuracy);
  PM.setObstacleFriction(its.friction);
  scene.build();
  auto* p_body = new Body;
  const bool is_upright = scene.along.x() == 0;
  p_body->setBoxShape(is_upright ? scene.height : its.width, is_upright ? its.width : scene.height);
  p_body->setPosition(scene.start);
  p_body->setFriction(its.friction);
  p_body->setTurning(its.turns);
  p_body->setVelocity(Vector(its.push.speed * scene.along.x(), its.push.speed * scene.along.y()));
  return own.states(scene.ticks, {p_body}, [&](int /*tick*/) {
    if (its.push.force > 0)
      p_body->applyForce(Vector(its.push.force * scene.along.x(), its.push.force * scene.along.y()));
  });
}
bool areSame(TileScene scene, const TileCase& its, const Build& tiles) {
  const Path one = pathOver(scene, its);
  scene.build = tiles;
  return pathOver(scene, its) == one;
}

// Calls visit() for each combination; returns in how many of them it returned false.
int forAll(const std::function<bool(const TileCase&)>& visit) {
  int failures = 0;
  for (const double aspect : {1., 2.}) {
    for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
      for (const double friction : {0., .5}) {
        for (const bool turns : {false, true}) {
          for (const double width : {.9, 1., 1.5, 2., 3., 4.}) {
            if (aspect > 1 && width != 1 && width != 3) continue;
            for (const Push push : kPushes) {
              const TileCase its = {width, push, friction, turns, accuracy, aspect};
              if (visit(its)) continue;
              if (++failures <= 5) ADD_FAILURE() << its.name();
            }
          }
        }
      }
    }
  }
  return failures;
}

double xOf(const BodyBits& bits) {
  return std::bit_cast<double>(bits[0]);
}

// Checks that a box moves over tiles as over single Objects.
void expectSame(const TileScene& scene, const Build& tiles) {
  EXPECT_EQ(forAll([&](const TileCase& its) { return areSame(scene, its, tiles); }), 0);
}

TEST_F(BodyTiles, FlatRowsOfTilesAreLikeOneObject) {
  expectSame({[] { block(0, 0, 100, 1); }, Vector(5.3, -.5)}, [] { tiles(0, 0, 100, 1); });
  expectSame({[] { block(0, -1, 100, 1); }, Vector(5.3, .5), Vector(0, -.01), Vector(1, 0), 1, 20},
             [] { tiles(0, -1, 100, 1); });
  expectSame({[] { block(0, 0, 2, 100); }, Vector(-.5, 5.3), Vector(.01, 0), Vector(0, 1), 1, 20},
             [] { tiles(0, 0, 2, 100); });
  const int failures = forAll([](const TileCase& its) {
    if (its.push.speed == 0 || its.friction > 0) return true;
    const double end = xOf(pathOver({[] { tiles(0, 0, 100, 1); }, Vector(5.3, -.5)}, its).back());
    return std::abs(end - (5.3 + 40 * its.push.speed)) <= .01;
  });
  EXPECT_EQ(failures, 0);
}

// A box slides over the floor into a wall, or falls along the wall into the corner.
TEST_F(BodyTiles, InnerCornerOfTilesIsLikeTwoObjects) {
  const auto single = [] { block(0, 0, 40, 1), block(12, -9, 1, 9); };
  const auto tiled = [] { tiles(0, 0, 40, 1), tiles(12, -9, 1, 9); };
  const int failures = forAll([&](const TileCase& its) {
    const double left = 12 - .5 * its.width;
    return areSame({single, Vector(left - 3, -.5), Vector(0, .01), Vector(1, 0), 1, 20}, its, tiled) &&
           areSame({single, Vector(left, -2), Vector(0, .01), Vector(1, 0), 1, 25}, its, tiled);
  });
  EXPECT_EQ(failures, 0);
}

// A step of half a cell stops a box, and a box slides down from one, onto tiles as onto single Objects.
TEST_F(BodyTiles, StepsOfTilesAreLikeStepsOfSingleObjects) {
  const auto single = [] { block(0, 0, 40, 1), block(12, -.5, 20, .5); };
  const auto tiled = [] {
    tiles(0, 0, 40, 1);
    for (int i = 0; i < 20; ++i) block(12 + i, -.5, 1, .5);
  };
  const int failures = forAll([&](const TileCase& its) {
    TileCase back = its;
    back.push.speed = -its.push.speed, back.push.force = 0;
    return areSame({single, Vector(11 - .5 * its.width, -.5), Vector(0, .01), Vector(1, 0), 1, 20}, its,
                   tiled) &&
           areSame({single, Vector(13 + .5 * its.width, -1), Vector(0, .01), Vector(1, 0), 1, 20}, back,
                   tiled);
  });
  EXPECT_EQ(failures, 0);
}

// Boxes slide down stairs of tiles as down stairs of single Objects, and nothing catches them.
TEST_F(BodyTiles, NothingCatchesOnTheWayDownStairs) {
  constexpr double kStep = .125;
  const auto single = [] {
    for (int i = 0; i < 30; ++i) block(30 - i, 10 - kStep * i, 1, kStep * (i + 1));
  };
  const auto tiled = [] {
    for (int i = 0; i < 30; ++i) {
      for (int row = 0; row <= i; ++row) block(30 - i, 10 - kStep * row, 1, kStep);
    }
  };
  const int failures = forAll([&](const TileCase& its) {
    if (its.friction > 0 || its.push.speed == 0 || its.aspect > 1) return true;
    const TileScene scene = {single, Vector(2, 10 - 29 * kStep - .5), Vector(0, .01), Vector(1, 0), 1, 20};
    if (its.accuracy == ACCURACY_DEFAULT && !its.turns) {
      EXPECT_NEAR(xOf(pathOver(scene, its).back()), 2 + 20 * its.push.speed, 1e-9) << its.name();
    }
    return areSame(scene, its, tiled);
  });
  EXPECT_EQ(failures, 0);
}

// Bodies that move together act as one, too.
TEST_F(BodyTiles, KinematicTilesAreLikeOneKinematicBody) {
  const auto lift = [](double left, double width) {
    auto* p_lift = new Body;
    p_lift->setBoxShape(width, 1);
    p_lift->setPosition(Vector(left + .5 * width, .5));
    p_lift->setKinematic();
    p_lift->setVelocity(Vector(.125, -.03125));
  };
  const int failures = forAll([&](const TileCase& its) {
    if (its.accuracy == ACCURACY_DEFAULT && !its.turns) return true;  // for an ImpactWorld
    const TileScene scene = {[&] { lift(0, 60); }, Vector(5.25, -.5), Vector(0, .01), Vector(1, 0), 1, 20};
    return areSame(scene, its, [&] {
      for (int i = 0; i < 60; ++i) lift(i, 1);
    });
  });
  EXPECT_EQ(failures, 0);
}

// Objects below a floor, or next to it at its level, do not disturb bodies that slide over it.
TEST_F(BodyTiles, OnlyTheSurfaceMatters) {
  const auto tiled = [] {
    for (int i = 0; i < 100; ++i) {
      block(i, 0, 1, i % 3 == 0 ? 3 : 1);  // flush at the top
      if (i % 5 == 1) tiles(i, 1, 1, 4);   // pillars below
    }
  };
  expectSame({[] { block(0, 0, 100, 1); }, Vector(5.3, -.5), Vector(0, .01), Vector(1, 0), 1, 25}, tiled);
}

// Merged bodies keep their own friction.
TEST_F(BodyTiles, KinematicTilesKeepTheirFriction) {
  for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
    OwnWorld own(1, Vector(0, .01), accuracy);
    for (int i = 0; i < 40; ++i) {
      auto* p_tile = crate(Vector(i + .5, .5));
      p_tile->setKinematic();
      p_tile->setFriction(i < 12 ? 0 : .5);
    }
    Body* p_body = turningCrate(Vector(5, -.25), Vector(1, .25));
    p_body->setFriction(.5);
    p_body->setVelocity(Vector(.3, 0));
    double before = .3;
    for (int i = 0; i < 50; ++i) {
      own.world.update();
      const double x = p_body->getPosition().x(), speed = p_body->getVelocity().x();
      if (x < 10.6) {
        EXPECT_NEAR(speed, .3, 1e-4) << x;
      } else if (x > 13.5) {
        EXPECT_NEAR(before - speed, .005, .0015) << x;
      }
      before = speed;
    }
    EXPECT_GT(p_body->getPosition().x(), 14);
  }
}

// Each tile that a body passes gets one begin and one end of contact, in their order.
TEST_F(BodyTiles, EachTileHasItsOwnContact) {
  int failures = 0;
  for (const bool is_kinematic : {false, true}) {
    failures += forAll([is_kinematic](const TileCase& its) {
      if (its.push.speed == 0 || its.friction > 0) return true;
      if (is_kinematic && its.accuracy == ACCURACY_DEFAULT && !its.turns) return true;  // for an ImpactWorld
      OwnWorld own(its.aspect, Vector(0, .01), its.accuracy);
      if (!is_kinematic) tiles(0, 0, 100, 1);
      for (int i = 0; i < 100 && is_kinematic; ++i) crate(Vector(i + .5, .5))->setKinematic();
      auto* p_body = new Listener;
      p_body->setBoxShape(its.width, 1);
      p_body->setPosition(Vector(5.3, -.5));
      p_body->setFriction(0);
      p_body->setTurning(its.turns);
      p_body->setContactEnds();
      p_body->setVelocity(Vector(its.push.speed, 0));
      for (int i = 0; i < 40; ++i) own.world.update();
      const double end = p_body->getPosition().x();
      int touched = 0, touching = 0;
      for (const auto& [pair, is_touching] : p_body->expectTurns()) {
        ++touched;
        touching += is_touching ? 1 : 0;
      }
      const auto cells = [&](double from, double to) {
        return static_cast<int>(std::floor(to + .5 * its.width) - std::floor(from - .5 * its.width)) + 1;
      };
      return p_body->begins() == touched && touching == cells(end, end) && touched == cells(5.3, end) &&
             p_body->ends() == touched - touching;
    });
  }
  EXPECT_EQ(failures, 0);
}

// A body that hits a floor and a ceiling of tiles in each tick leaves them in each tick.
TEST_F(BodyTiles, EachBounceBeginsAndEndsAContact) {
  PM.setObstacleRestitution(1);
  tiles(0, 0, 6, 1);
  tiles(0, -7, 6, 1);
  auto* p_body = turningCrate<Listener>(Vector(2.5, -3), Vector(.4, .5));
  p_body->setRestitution(1);
  p_body->setFriction(0);
  p_body->setContactEnds();
  p_body->setVelocity(Vector(0, 10));
  ticks(10);
  EXPECT_GE(p_body->begins(), 18);
  p_body->expectTurns();
}

// Begin and end events alternate, also in the tick in which a tile moves into its neighbour and the body.
TEST_F(BodyTiles, EventsAlternateWhenATileMoves) {
  for (int i = 0; i < 400; ++i) {
    OwnWorld own(1, Vector(), ACCURACY_FAST);
    PM.setObstacleFriction(0);
    wall(Vector(0, .25), Vector(.25, .25));
    wall(Vector(.5, .25), Vector(.25, .25));
    Object* p_tile = wall(Vector(1, .25), Vector(.25, .25));
    auto* p_body = turningCrate<Listener>(Vector(-.15, -.3), Vector(.5, .25));
    p_body->setFriction(0);
    p_body->setContactEnds();
    p_body->setVelocity(Vector(.3, 0));
    own.world.update();
    p_tile->setPosition(Vector(.75 + .005 * (i % 40), .04 + .001 * (i / 40)));
    for (int tick = 0; tick < 2; ++tick) own.world.update();
    p_body->expectTurns();
    ASSERT_FALSE(HasFailure()) << i;
  }
}

// A body that rests or sleeps falls when a tile below it goes, and stays when the next one goes.
TEST_F(BodyTiles, ABodyFallsWhenItsTileGoes) {
  for (const bool turns : {false, true}) {
    for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
      OwnWorld own(1, Vector(0, .01), accuracy);
      std::vector<Object*> all;
      for (int i = 0; i < 40; ++i) all.push_back(block(i, 0, 1, 1));
      Body* p_body = crate(Vector(20.5, -.5), Vector(.3, .5));
      p_body->setTurning(turns);
      for (int i = 0; i < 60; ++i) own.world.update();
      const Vector rest = p_body->getPosition();
      delete all[22];
      for (int i = 0; i < 20; ++i) own.world.update();
      EXPECT_NEAR(p_body->getPosition().y(), rest.y(), 1e-3);
      delete all[20];
      for (int i = 0; i < 10; ++i) own.world.update();
      EXPECT_NEAR(p_body->getPosition().y(), rest.y() + .55, .06) << turns << accuracy;
    }
  }
}

// A body falls into a hole that a handler makes in front of it, as into one that was always there.
TEST_F(BodyTiles, AHoleAppearsWhenAHandlerMakesIt) {
  for (const bool turns : {false, true}) {
    for (const Accuracy accuracy : {ACCURACY_DEFAULT, ACCURACY_FAST}) {
      std::array<Vector, 2> ends;
      for (const bool is_dug : {false, true}) {
        OwnWorld own(1, Vector(0, .01), accuracy);
        PM.setObstacleFriction(0);
        std::vector<Object*> all, hole;
        for (int i = 0; i < 40; ++i) all.push_back(block(i, 0, 1, 1));
        for (int i = 12; i < 16; ++i) hole.push_back(all[at(i)]);
        if (!is_dug) {
          for (Object* p_object : hole) delete p_object;
          hole.clear();
        }
        auto* p_body = crate<Touchy<Body>>(Vector(5.3, -.5));
        p_body->setFriction(0);
        p_body->setTurning(turns);
        p_body->setVelocity(Vector(.1, 0));
        p_body->on_contact = [&hole, p_trigger = all[11]](const Object* p_other) {
          if (p_other != p_trigger) return;
          for (Object* p_object : hole) WM.markForDelete(p_object);
          hole.clear();
        };
        for (int i = 0; i < 90; ++i) own.world.update();
        EXPECT_TRUE(hole.empty());
        ends[is_dug ? 1 : 0] = p_body->getPosition();
      }
      const double most = accuracy == ACCURACY_FAST ? .01 : 1e-6;
      EXPECT_GT(ends[0].y(), .1);
      EXPECT_NEAR(ends[1].x(), ends[0].x(), most) << turns << accuracy;
      EXPECT_NEAR(ends[1].y(), ends[0].y(), most) << turns << accuracy;
    }
  }
}

}  // namespace
}  // namespace df::test
