// Tests that each judge finds a planted fault, and nothing in a course without one.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "Judges.h"
#include "Shrink.h"

namespace hunt {
namespace {

constexpr int kTicks = 40;

// One body of mass 1 that flies at a constant velocity in empty space.
struct Flight {
  Flight() {
    scene.gravity = {};
    scene.ticks = kTicks;
    scene.bodies = {
        {.parts = {Part{}}, .restitution = 1, .friction = 0, .turning = true, .contact_ends = true}};
    scene.bodies[0].velocity = {.125, 0};
    for (int i = 0; i <= kTicks; ++i) {
      Tick& tick = course.ticks.emplace_back();
      tick.bodies = {{.place = {.125 * i, 0}, .velocity = {.125, 0}, .present = true}};
      tick.sums.kinetic = .0078125;
      tick.sums.momentum = {.125, 0};
      tick.sums.momentum_scale = .125;
    }
  }
  template <class Value>
  void set(int from, Value Sums::*sum, Value value) {  // in all ticks from this one on
    for (; from <= kTicks; ++from) at(course.ticks, from).sums.*sum = value;
  }
  void change(int from, const std::function<void(Tick&)>& change) {
    for (; from <= kTicks; ++from) change(at(course.ticks, from));
  }
  void meet(std::initializer_list<int> ticks) {  // contacts begin and end in turns
    for (const int tick : ticks)
      course.events.push_back({tick, course.events.size() % 2 == 0, 0, 0, obstacleNumber(0)});
  }
  void enclose(Boundary::Kind kind, Vec2 lower, Vec2 upper, Vec2 velocity = {}) {
    scene.boundaries = {{kind, lower, upper, velocity}};
  }

  SceneData scene;
  Recording course;
};

// Checks that these judges find the change of a flight, and those with - do not.
void check(const std::string& names, const std::function<void(Flight&)>& change) {
  Flight its;
  change(its);
  std::istringstream words(names);
  for (std::string name; words >> name;) {
    const bool finds = name[0] != '-';
    const Answer answer = judgeNamed(name.substr(finds ? 0 : 1))->ask({its.scene, its.course});
    EXPECT_TRUE(answer.applies) << names;
    EXPECT_EQ(answer.finding.has_value(), finds) << names;
  }
}

TEST(HuntJudges, FindPlantedFaultsAndNothingElse) {
  constexpr auto kKinetic = &Sums::kinetic;
  check("-gain -loss -momentum -overlap -opening -events -finite -speed", [](Flight&) {});
  check("gain loss", [](Flight& its) { its.set(20, kKinetic, .008); });
  check("-gain", [](Flight& its) { its.set(10, kKinetic, .001); });
  check("gain", [](Flight& its) { its.set(10, kKinetic, .001), its.set(15, kKinetic, .002); });  // no credit
  check("-gain", [](Flight& its) { its.set(20, kKinetic, .01), at(its.course.ticks, 20).acted = true; });
  check("-gain", [](Flight& its) {  // lifted out of an overlap
    its.set(0, &Sums::pull, 1.0), its.set(20, &Sums::potential, .009), at(its.course.ticks, 19).shift = .01;
  });
  check("momentum", [](Flight& its) { its.set(kTicks, &Sums::momentum, Vec2{.125, 1e-8}); });
  check("momentum", [](Flight& its) { its.set(kTicks, &Sums::angular, 1e-8); });
  check("fall", [](Flight& its) { its.scene.gravity.y = .01, its.set(0, &Sums::force, Vec2{0, .01}); });
  check("overlap", [](Flight& its) { at(its.course.ticks, 5).depth = .3; });
  check("finite", [](Flight& its) { at(its.course.ticks, 7).bodies[0].spin = std::nan(""); });
  check("speed", [](Flight& its) { its.course.limited = 1; });
  check("rest", [](Flight& its) { its.scene.ticks = 1000; });
  check("-rest", [](Flight& its) {
    its.scene.ticks = 1000, its.change(0, [](Tick& tick) { tick.bodies[0].velocity = {}; });
  });
}

TEST(HuntJudges, FindBodiesBeyondAWall) {
  const auto wall = [](Flight& its) { its.enclose(Boundary::Kind::WALL_X, {2, -50}, {2.05, 50}); };
  check("through", wall);
  check("-through", [&](Flight& its) {  // around it
    wall(its), its.change(0, [](Tick& tick) { tick.bodies[0].place.y = 60; });
  });
  check("-through", [](Flight& its) { its.enclose(Boundary::Kind::ROOM, {-1, -9}, {1, 9}, {.125, 0}); });
}

TEST(HuntJudges, FindUnpairedEvents) {
  check("-events", [](Flight& its) { its.meet({3, 5, 8}); });
  check("events", [](Flight& its) { its.meet({3, 5, 8, 9}), its.course.events.back().begins = true; });
  check("events", [](Flight& its) { its.meet({3}), its.course.events.back().begins = false; });
  check("events", [](Flight& its) { its.meet({3, 5, 8}), its.course.events.back().gap = 1; });
  check("events", [](Flight& its) {
    its.meet({3, 5, 8}), its.change(20, [](Tick& tick) { tick.open = {{0, obstacleNumber(0), 8, true}}; });
  });
}

// The course is that of another scene, as if the product had computed it wrongly.
TEST(HuntJudges, FindCoursesThatDifferFromASecondRun) {
  const auto soften = [](Flight& its) { its.scene.bodies[0].restitution = 0; };
  check("-isolation -levels -rebuild", soften);
  check("isolation levels",
        [&](Flight& its) { soften(its), its.change(0, [](Tick& tick) { tick.bodies[0].place.x *= 2; }); });
  check("rebuild tiles", [](Flight& its) {
    its.change(30, [](Tick& tick) { tick.bodies[0].place.y = .1; });
    for (const double x : {0, 2})
      its.scene.obstacles.push_back(
          {.row = 0, .parts = {{.size = {2, 2}}}, .kinematic = true, .place = {x, 99}});
  });
}

TEST(HuntScenes, AreTheirSeeds) {
  for (const std::uint64_t seed : {1u, 2u, 77u}) {
    EXPECT_EQ(programOf(drawScene(seed), ""), programOf(drawScene(seed), ""));
    EXPECT_NE(programOf(drawScene(seed), ""), programOf(drawScene(seed + 1), ""));
  }
}

// A ball falls onto one wall of a pair: the other, and the setter, have no part in a wrong course.
TEST(HuntScenes, ShrinkToWhatTheFaultNeeds) {
  SceneData scene = Flight().scene;
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].place = {0, 50};
  scene.bodies[1].velocity = {};
  scene.boundaries = {{Boundary::Kind::WALL_X, {2, -20}, {2.05, 20}, {}}};  // without an Object: no wall
  scene.actions = {{.tick = 3, .p_setter = &setterNamed("friction"), .target = 1, .x = .5}};
  const SceneData small = shrink(scene, *judgeNamed("through"), 100);
  EXPECT_TRUE(small.bodies[0].present);
  EXPECT_FALSE(small.bodies[1].present);
  EXPECT_FALSE(small.actions[0].present);
  EXPECT_NE(programOf(small, "").find("bodies[0]->setVelocity(Vector("), std::string::npos);
}

}  // namespace
}  // namespace hunt
