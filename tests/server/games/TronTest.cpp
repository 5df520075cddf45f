#include <gtest/gtest.h>

#include "GameMains.h"
#include "HighScores.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

int freeCells(const Object& cycle, Vector way) {
  Vector at = cycle.getPosition();
  for (int i = 0; i < 30; ++i) {
    at = at + way;
    if (WM.isCollision(&cycle, at)) return i;
  }
  return 30;
}

/// A player that turns to the side with more free cells if something is in front.
class CarefulRider {
 public:
  CarefulRider(World& world, std::uint32_t player) : m_world(world), m_player(player) {}

  void ride() {
    const Object* p_cycle = m_world.views().player(m_player)->getObject();
    if (p_cycle == nullptr) return;
    const Vector at = p_cycle->getPosition();
    if (at != m_before) m_way = at - m_before;
    m_before = at;
    if (std::abs(m_way.x()) + std::abs(m_way.y()) != 1) return;  // the cycle was placed for a new round
    if (freeCells(*p_cycle, m_way) >= 2) return;
    const bool level = m_way.y() == 0;
    const Vector one = level ? Vector(0, -1) : Vector(-1, 0);
    const Vector other = level ? Vector(0, 1) : Vector(1, 0);
    const bool first = freeCells(*p_cycle, one) > freeCells(*p_cycle, other);
    if (level) tap(m_world, m_player, first ? Keyboard::UPARROW : Keyboard::DOWNARROW);
    if (!level) tap(m_world, m_player, first ? Keyboard::LEFTARROW : Keyboard::RIGHTARROW);
  }

 private:
  World& m_world;
  std::uint32_t m_player;
  Vector m_before;
  Vector m_way;
};

TEST(Tron, ACarefulRiderWinsARoundAgainstTheRobot) {
  hostGame(tron_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world);
    CarefulRider rider(world, ann);
    for (int t = 0; t < 9000 && world.views().player(ann)->getScore() == 0; ++t) {
      rider.ride();
      world.tick();
    }
    EXPECT_EQ(world.views().player(ann)->getScore(), 1);
    EXPECT_NE(world.picture().renderPlayer(ann).text().find("ann wins"), std::string::npos);
    const auto rides = HighScores("rides").best();
    ASSERT_EQ(rides.size(), 1u);
    EXPECT_EQ(rides[0].name, "ann");
    EXPECT_GT(rides[0].points, 10);
    tick(world, 2);
    EXPECT_TRUE(shows(world, ann, "best " + std::to_string(rides[0].points) + " ann"));
  });
}

TEST(Tron, RiderThatNeverTurnsLosesToTheOther) {
  hostGame(tron_main, 1, [](World& world) {
    const std::uint32_t ann = world.input().join("ann", RED);
    const std::uint32_t bob = world.input().join("bob", GREEN);
    tick(world, 2);
    ASSERT_EQ(world.objects().objectsOfType("Cycle").getCount(), 2) << "no robot where there are two";
    CarefulRider rider(world, bob);
    for (int t = 0; t < 1000 && world.views().player(bob)->getScore() == 0; ++t) {
      rider.ride();
      world.tick();
    }
    EXPECT_EQ(world.views().player(bob)->getScore(), 1);
    EXPECT_EQ(world.views().player(ann)->getScore(), 0);
  });
}

TEST(Tron, LatePlayersWaitAndLeavingPlayersLose) {
  hostGame(tron_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 60);
    const std::uint32_t bob = world.input().join("bob", GREEN);
    tick(world, 2);
    EXPECT_NE(world.picture().renderPlayer(bob).text().find("next round"), std::string::npos);
    world.input().leave(ann);
    tick(world, 5);
    EXPECT_NE(world.picture().renderPlayer(bob).text().find("the robot wins"), std::string::npos);
    tick(world, 140);
    EXPECT_EQ(world.views().player(bob)->getObject()->getType(), "Cycle");
    EXPECT_GE(world.objects().objectsOfType("Trail").getCount(), 1);
    EXPECT_LT(world.objects().objectsOfType("Trail").getCount(), 60) << "the field was cleaned";
  });
}

}  // namespace
}  // namespace naiad
