// Tests that each judge finds a planted fault, and nothing in a course without one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "Judges.h"
#include "RerunJudges.h"
#include "Shrink.h"

namespace hunt {
namespace {

constexpr int kTicks = 40;

// One body of mass 1 that flies at a constant velocity in empty space.
struct Flight {
  Flight() {
    scene.gravity = {};
    scene.ticks = kTicks;
    BodyData body;
    body.parts = {Part{}};
    body.velocity = {.125, 0};
    body.turning = true;
    body.restitution = 1;
    body.friction = 0;
    body.contact_ends = true;
    scene.bodies.push_back(body);
    for (int i = 0; i <= kTicks; ++i) {
      Tick tick;
      tick.bodies = {{.place = {.125 * i, 0}, .velocity = {.125, 0}, .present = true}};
      tick.sums.kinetic = .0078125;
      tick.sums.momentum = {.125, 0};
      tick.sums.momentum_scale = .125;
      course.ticks.push_back(tick);
    }
  }
  Tick& at(int tick) { return course.ticks[static_cast<std::size_t>(tick)]; }
  bool isFoundBy(const char* name) const {
    const Trial trial{scene, course};
    const Judge& judge = *judgeNamed(name);
    EXPECT_TRUE(judge.applies(trial)) << name;
    return judge.find(trial).has_value();
  }
  void meet(int tick, bool begins) { course.events.push_back({tick, begins, 0, 0, obstacleNumber(0), -1}); }

  SceneData scene;
  Recording course;
};

TEST(HuntJudges, FindNothingInAFlight) {
  const Flight flight;
  for (const char* name : {"gain", "loss", "momentum", "overlap", "opening", "events", "finite", "speed"})
    EXPECT_FALSE(flight.isFoundBy(name)) << name;
}

TEST(HuntJudges, FindEnergyThatGrows) {
  Flight flight;
  for (int i = 20; i <= kTicks; ++i) flight.at(i).sums.kinetic = .008;
  EXPECT_TRUE(flight.isFoundBy("gain"));
  EXPECT_TRUE(flight.isFoundBy("loss"));
}

TEST(HuntJudges, GiveNoCreditForEarlierLosses) {
  Flight flight;
  for (int i = 10; i <= kTicks; ++i) flight.at(i).sums.kinetic = .001;
  EXPECT_FALSE(flight.isFoundBy("gain"));
  for (int i = 15; i <= kTicks; ++i) flight.at(i).sums.kinetic = .002;
  EXPECT_TRUE(flight.isFoundBy("gain"));
}

TEST(HuntJudges, AllowEnergyFromSettersAndFromOverlaps) {
  Flight pushed;
  for (int i = 20; i <= kTicks; ++i) pushed.at(i).sums.kinetic = .01;
  pushed.at(20).acted = true;
  EXPECT_FALSE(pushed.isFoundBy("gain"));
  Flight lifted;
  for (int i = 0; i <= kTicks; ++i) lifted.at(i).sums.pull = 1;
  lifted.at(19).shift = .01;
  for (int i = 20; i <= kTicks; ++i) lifted.at(i).sums.potential = .009;
  EXPECT_FALSE(lifted.isFoundBy("gain"));
}

TEST(HuntJudges, FindChangesOfMomentum) {
  Flight flight;
  flight.at(kTicks).sums.momentum.y = 1e-8;
  EXPECT_TRUE(flight.isFoundBy("momentum"));
  Flight turned;
  turned.at(kTicks).sums.angular = 1e-8;
  EXPECT_TRUE(turned.isFoundBy("momentum"));
  Flight falling;
  falling.scene.gravity = {0, .01};
  for (Tick& tick : falling.course.ticks) tick.sums.force = {0, .01};
  EXPECT_TRUE(falling.isFoundBy("fall")) << "it does not fall";
}

TEST(HuntJudges, FindOverlapsAndLostNumbers) {
  Flight flight;
  flight.at(5).depth = .3;
  EXPECT_TRUE(flight.isFoundBy("overlap"));
  flight.at(7).bodies[0].spin = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(flight.isFoundBy("finite"));
  flight.course.limited = 1;
  EXPECT_TRUE(flight.isFoundBy("speed"));
}

TEST(HuntJudges, FindBodiesBeyondAWall) {
  Flight flight;
  flight.scene.boundaries = {{Boundary::Kind::WALL_X, {2, -50}, {2.05, 50}, {}}};
  EXPECT_TRUE(flight.isFoundBy("through"));
  for (Tick& tick : flight.course.ticks) tick.bodies[0].place.y = 60;  // around the wall
  EXPECT_FALSE(flight.isFoundBy("through"));
  flight.scene.boundaries = {{Boundary::Kind::ROOM, {-1, -100}, {1, 100}, {.125, 0}}};  // moves along
  EXPECT_FALSE(flight.isFoundBy("through"));
}

TEST(HuntJudges, FindUnpairedEvents) {
  Flight paired;
  paired.meet(3, true);
  paired.meet(5, false);
  paired.meet(8, true);
  EXPECT_FALSE(paired.isFoundBy("events"));
  Flight twice = paired;
  twice.meet(9, true);
  EXPECT_TRUE(twice.isFoundBy("events"));
  Flight early;
  early.meet(3, false);
  EXPECT_TRUE(early.isFoundBy("events"));
  Flight far = paired;
  far.course.events.back().gap = 1;
  EXPECT_TRUE(far.isFoundBy("events"));
  Flight lost = paired;
  for (int i = 20; i <= kTicks; ++i) lost.at(i).open = {{0, obstacleNumber(0), true}};
  EXPECT_TRUE(lost.isFoundBy("events"));
}

TEST(HuntJudges, FindHeapsThatNeverRest) {
  Flight flight;
  flight.scene.ticks = 1000;
  EXPECT_TRUE(flight.isFoundBy("rest"));
  for (Tick& tick : flight.course.ticks) tick.bodies[0].velocity = {};
  EXPECT_FALSE(flight.isFoundBy("rest"));
}

// The course is that of another scene, as if the product had computed it wrongly.
TEST(HuntJudges, FindCoursesThatDifferFromASecondRun) {
  Flight flight;
  flight.scene.bodies[0].restitution = 0;
  for (const char* name : {"isolation", "levels", "rebuild"}) EXPECT_FALSE(flight.isFoundBy(name)) << name;
  for (Tick& tick : flight.course.ticks) tick.bodies[0].place.x *= 2;
  for (const char* name : {"isolation", "levels"}) EXPECT_TRUE(flight.isFoundBy(name)) << name;
  Flight bent;
  for (int i = 30; i <= kTicks; ++i) bent.at(i).bodies[0].place.y = .1;
  EXPECT_TRUE(bent.isFoundBy("rebuild"));
  bent.scene.obstacles = {{.row = 0, .centre = {0, 99}, .half = {1, 1}},
                          {.row = 0, .centre = {2, 99}, .half = {1, 1}}};
  EXPECT_TRUE(bent.isFoundBy("tiles"));
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
  scene.actions = {{.tick = 3, .kind = Action::Kind::FRICTION, .target = 1, .x = .5}};
  const SceneData small = shrink(scene, *judgeNamed("through"), 100);
  EXPECT_TRUE(small.bodies[0].present);
  EXPECT_FALSE(small.bodies[1].present);
  EXPECT_FALSE(small.actions[0].present);
  EXPECT_NE(programOf(small, "").find("bodies[0]->setVelocity(Vector("), std::string::npos);
}

}  // namespace
}  // namespace hunt
