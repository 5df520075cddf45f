#include <gtest/gtest.h>

#include <vector>

#include "GameMains.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

/// Returns the smallest distance of bullets from this place in the next ticks.
double danger(const World& world, Vector ship, Vector velocity) {
  double nearest = 100;
  const ObjectList shots = world.objects().objectsOfType("Theirs");
  for (int i = 0; i < shots.getCount(); ++i) {
    const Vector at = shots[i]->getPosition();
    const Vector going = shots[i]->getVelocity();
    for (int t = 1; t <= 14; ++t) {
      const double x = at.x() + going.x() * t - ship.x() - velocity.x() * std::min(t, 6);
      const double y = at.y() + going.y() * t - ship.y() - velocity.y() * std::min(t, 6);
      nearest = std::min(nearest, std::max(std::abs(x), std::abs(y)) + 0.04 * t);
    }
  }
  return nearest;
}

/// Moves to where there are no bullets; if several places are equally good, to the one below the boss.
std::set<Keyboard::Key> dodge(const World& world, const Object& ship) {
  struct Way {
    std::set<Keyboard::Key> keys;
    Vector velocity;
  };
  static const std::vector<Way> kWays = {{{}, Vector()},
                                         {{Keyboard::LEFTARROW}, Vector(-0.7, 0)},
                                         {{Keyboard::RIGHTARROW}, Vector(0.7, 0)},
                                         {{Keyboard::UPARROW}, Vector(0, -0.35)},
                                         {{Keyboard::DOWNARROW}, Vector(0, 0.35)}};
  const ObjectList bosses = world.objects().objectsOfType("Boss");
  const double target = bosses.isEmpty() ? 40 : bosses[0]->getPosition().x();
  const Way* p_best = nullptr;
  double best = -1e9;
  for (const Way& way : kWays) {
    const Vector then = ship.getPosition() + Vector(way.velocity.x() * 6, way.velocity.y() * 6);
    if (then.x() < 2 || then.x() > 77 || then.y() < 12 || then.y() > 22) continue;
    const double worth = 10 * std::min(danger(world, ship.getPosition(), way.velocity), 1.6) -
                         0.05 * std::abs(then.x() - target) - 0.05 * std::abs(then.y() - 20);
    if (worth <= best) continue;
    best = worth;
    p_best = &way;
  }
  return p_best != nullptr ? p_best->keys : std::set<Keyboard::Key>{};
}

TEST(BulletHell, DodgingBotBeatsTheFirstBoss) {
  hostGame(bullethell_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world);
    Fingers fingers(world, ann);
    int t = 0;
    for (; t < 6000 && !shows(world, ann, "level 2"); ++t) {
      fingers.hold(dodge(world, *world.views().player(ann)->getObject()));
      world.tick();
    }
    EXPECT_TRUE(shows(world, ann, "level 2")) << "after " << t << " ticks";
    EXPECT_GE(world.views().player(ann)->getScore(), 50);
  });
}

TEST(BulletHell, IdlePlayerLosesThreeLivesAndTheGameRestarts) {
  hostGame(bullethell_main, 1, [](World& world) {
    const std::uint32_t ann = joinAnn(world, 2);
    EXPECT_TRUE(shows(world, ann, "lives 3"));
    std::string seen;
    for (int t = 0; t < 6000 && seen != "321"; ++t) {
      world.tick();
      for (const char* lives : {"3", "2", "1"}) {
        if (shows(world, ann, std::string("lives ") + lives) && seen.find(lives) == std::string::npos)
          seen += lives;
      }
    }
    EXPECT_EQ(seen, "321");
    for (int t = 0; t < 3000 && !shows(world, ann, "lives 3"); ++t) world.tick();
    EXPECT_TRUE(shows(world, ann, "lives 3"));
    EXPECT_TRUE(shows(world, ann, "level 1"));
  });
}

TEST(BulletHell, HundredsOfBulletsFlyAndLeave) {
  hostGame(bullethell_main, 1, [](World& world) {
    for (int i = 0; i < 4; ++i) world.input().join("bot", RED);
    int most = 0;
    for (int t = 0; t < 4000; ++t) {
      world.tick();
      most = std::max(most, world.objects().objectsOfType("Theirs").getCount());
      ASSERT_LT(world.store().countInWorld(), 600);
    }
    EXPECT_GE(most, 150);
  });
}

}  // namespace
}  // namespace naiad
