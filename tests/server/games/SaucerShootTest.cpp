#include <gtest/gtest.h>

#include "GameMains.h"
#include "HighScores.h"
#include "HostedGame.h"
#include "ViewObject.h"
#include "detail/WorldView.h"
#include "shared/replica/PredictedObject.h"

namespace naiad {
namespace {

using df::Keyboard::Key;

constexpr int kShieldTicks = 60;
constexpr int kRelaunchTicks = 65;

void host(std::uint64_t seed, std::function<void(df::World&)> play) {
  bool played = false;
  const auto noted = [&](df::World& world) {
    played = true;
    play(world);
  };
  hostGame(saucershoot_main, seed, noted, "saucershoot");
  EXPECT_TRUE(played) << "the sprites are missing";
}

int score(df::World& world, std::uint32_t player) {
  return world.views().player(player)->getScore();
}

/// Adds a player "ann" and begins a round. Returns the player's id.
std::uint32_t joinAndFly(df::World& world) {
  const std::uint32_t player = world.input().join("ann", df::RED);
  tap(world, player, df::Keyboard::P);
  tick(world, 1);
  return player;
}

/// Like joinAndFly(), but also waits until the new ship can be hit.
std::uint32_t joinAndWait(df::World& world) {
  const std::uint32_t player = joinAndFly(world);
  tick(world, kShieldTicks + 1);
  return player;
}

/// Runs this many ticks, and in each of them moves the saucers away from the ship.
void tickInPeace(df::World& world, int count) {
  for (int t = 0; t < count; ++t) {
    const df::ObjectList saucers = world.objects().objectsOfType("Saucer");
    for (int i = 0; i < saucers.getCount(); ++i) {
      const df::Vector at = saucers[i]->getPosition();
      if (at.x() < 60) saucers[i]->setPosition(df::Vector(82, at.y()));
    }
    world.tick();
  }
}

/// Moves a saucer into the ship.
void crash(df::World& world, std::uint32_t player) {
  const df::Object* p_hero = world.views().player(player)->getObject();
  const df::ObjectList saucers = world.objects().objectsOfType("Saucer");
  ASSERT_FALSE(saucers.isEmpty());
  saucers[0]->setPosition(p_hero->getPosition() + df::Vector(1, 0));
  world.tick();
}

TEST(SaucerShoot, SaucersAreLimitedAndAvoidTheTextRows) {
  host(1, [](df::World& world) {
    const std::uint32_t first = joinAndFly(world);
    for (int i = 0; i < 11; ++i)
      world.input().join("pilot", df::RED);  // because many pilots get many
                                             // saucers
    int outside = 0;
    for (int t = 0; t < 6000; ++t) {
      if (t % 100 == 0) tap(world, first, df::Keyboard::P);  // begins another round if this one is over
      world.tick();
      const df::ObjectList saucers = WM.objectsOfType("Saucer");
      ASSERT_LE(saucers.getCount(), 32);
      ASSERT_LE(WM.objectsOfType("GameStart").getCount() + WM.objectsOfType("GameOver").getCount(), 1);
      for (int i = 0; i < saucers.getCount(); ++i) {
        const double y = saucers[i]->getPosition().y();
        if (y < 1.5 || y >= 20.5) ++outside;
      }
    }
    EXPECT_EQ(outside, 0);
  });
}

TEST(SaucerShoot, SimplestPlayHitsASaucerWithinFiveSeconds) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    host(seed, [&](df::World& world) {
      const std::uint32_t player = world.input().join("bot", df::RED);
      world.tick();
      for (int t = 0; t < 149; ++t) {
        if (t % 10 == 0) tap(world, player, df::Keyboard::SPACE);
        if (t % 10 == 5) tap(world, player, t % 100 < 50 ? df::Keyboard::DOWNARROW : df::Keyboard::UPARROW);
        world.tick();
      }
      EXPECT_GT(score(world, player), 0) << "seed " << seed;
    });
  }
}

TEST(SaucerShoot, AtLeastTwentyObjectsMoveOnTheScreen) {
  host(1, [](df::World& world) {
    for (int t = 0; t < 600; ++t) {
      world.tick();
      int moving = 0;
      const df::ObjectList all = world.objects().getAllObjects();
      for (int i = 0; i < all.getCount(); ++i) {
        moving += all[i]->getVelocity() != df::Vector() && all[i]->getPosition().x() < 79.5;
      }
      ASSERT_GE(moving, 20) << "tick " << t;
    }
  });
}

TEST(SaucerShoot, LeavingPlayersShipIsRemoved) {
  host(1, [](df::World& world) {
    const std::uint32_t ann = joinAndFly(world);
    const std::uint32_t bob = world.input().join("bob", df::GREEN);
    tick(world, 20);
    EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 2);
    tap(world, ann, df::Keyboard::SPACE);  // this bullet exists longer than its ship
    world.input().leave(ann);
    tick(world, 100);
    ASSERT_EQ(world.objects().objectsOfType("Hero").getCount(), 1);
    EXPECT_EQ(world.objects().objectsOfType("Hero")[0], world.views().player(bob)->getObject());
    world.input().leave(bob);
    tick(world, 3);
    EXPECT_EQ(world.objects().objectsOfType("GameStart").getCount(), 1);
    EXPECT_EQ(world.objects().objectsOfType("Points").getCount(), 0);
  });
}

TEST(SaucerShoot, TapMovesOneCellAndHoldMovesUntilReleased) {
  host(1, [](df::World& world) {
    const std::uint32_t player = joinAndFly(world);
    const df::Object* p_hero = world.views().player(player)->getObject();
    const df::Vector start = p_hero->getPosition();
    tap(world, player, df::Keyboard::RIGHTARROW);
    tap(world, player, df::Keyboard::S);
    tick(world, 5);
    EXPECT_EQ(p_hero->getPosition(), start + df::Vector(1, 1));

    world.input().key(player, df::Keyboard::D, df::KEY_PRESSED);
    tick(world, 10);
    world.input().key(player, df::Keyboard::D, df::KEY_RELEASED);
    tick(world, 10);
    EXPECT_GE(p_hero->getPosition().x(), start.x() + 11);
    EXPECT_EQ(p_hero->getVelocity(), df::Vector());
  });
}

TEST(SaucerShoot, ShipStopsWhenTheKeyReleaseIsLost) {
  host(1, [](df::World& world) {
    const std::uint32_t player = joinAndFly(world);
    world.input().key(player, df::Keyboard::D, df::KEY_PRESSED);
    tick(world, 2);
    const df::Object* p_hero = world.views().player(player)->getObject();
    EXPECT_NE(p_hero->getVelocity(), df::Vector());
    tick(world, 48);
    EXPECT_EQ(p_hero->getVelocity(), df::Vector());
    EXPECT_LT(p_hero->getPosition().x(), 70);
  });
}

ControlRecord recordOf(df::World& world, std::uint32_t player) {
  const df::SteeringFacts f = world.views().player(player)->facts().steering;
  return {static_cast<std::uint32_t>(world.getStepCount()),
          f.object.slot,
          f.object.generation,
          0,
          f.position,
          f.velocity,
          f.acceleration,
          f.state};
}

/// The data that a client has are enough to compute the ship's path until the ship is hit.
TEST(SaucerShoot, ControlsPredictTheShipsPath) {
  int foretold = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    host(seed, [&](df::World& world) {
      df::Random random(seed);
      const std::uint32_t player = joinAndWait(world);
      const df::ControlTable table = *world.views().player(player)->facts().steering.p_table;
      for (int t = 0; t < 500; ++t) {
        PredictedObject copy(recordOf(world, player), table);
        copy.beginTick();
        for (int k = random.below(3); k > 0; --k) {
          static constexpr Key kKeys[] = {df::Keyboard::W, df::Keyboard::LEFTARROW, df::Keyboard::S,
                                          df::Keyboard::D, df::Keyboard::SPACE};
          const Key key = kKeys[random.below(5)];
          const auto action = static_cast<df::EventKeyboardAction>(random.below(3));
          world.input().key(player, key, action);
          copy.applyKey(key, action);
        }
        copy.finishTick();
        const bool could_steer = copy.now().state.steering;
        world.tick();
        if (world.views().player(player)->getObject() == nullptr) break;  // the round is over
        const ControlRecord now = recordOf(world, player);
        if (could_steer != now.state.steering) continue;  // the ship was hit, or launched
        EXPECT_EQ(now, copy.now());
        ++foretold;
      }
    });
  }
  EXPECT_GT(foretold, 9000);
}

TEST(SaucerShoot, TheTitleWaitsForAKey) {
  host(1, [](df::World& world) {
    const std::uint32_t player = world.input().join("ann", df::RED);
    tick(world, 30);
    EXPECT_TRUE(shows(world, player, "SPACE or P: play"));
    EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 0);
    tap(world, player, df::Keyboard::X);
    world.tick();
    EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 0);
    tap(world, player, df::Keyboard::P);
    tap(world, player, df::Keyboard::P);  // begins only one round, not two
    tick(world, 2);
    EXPECT_FALSE(shows(world, player, "SPACE or P: play"));
    EXPECT_TRUE(shows(world, player, "Points 0"));
    EXPECT_TRUE(shows(world, player, "0 points  ships 3  nukes 1"));
    EXPECT_TRUE(shows(world, player, "##=>"));
    EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 1);
    const std::uint32_t late = world.input().join("bob", df::GREEN);
    world.tick();
    EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 2);
    EXPECT_NE(world.views().player(late)->getObject(), nullptr);
  });
}

TEST(SaucerShoot, LostShipIsReplacedTwiceThenTitleReturns) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    host(seed, [](df::World& world) {
      const std::uint32_t player = joinAndFly(world);
      df::Object* p_hero = world.views().player(player)->getObject();
      for (int ships = 2; ships >= 0; --ships) {
        tickInPeace(world, kShieldTicks);
        ASSERT_EQ(p_hero->getSolidness(), df::SOFT);  // the shield has ended
        crash(world, player);
        ASSERT_FALSE(p_hero->isVisible());
        EXPECT_TRUE(shows(world, player, "Hit!"));
        tickInPeace(world, 1);
        EXPECT_TRUE(shows(world, player, "ships " + std::to_string(ships)));
        if (ships == 0) break;
        tickInPeace(world, kRelaunchTicks);
        EXPECT_TRUE(p_hero->isVisible());
      }
      world.tick();
      EXPECT_TRUE(shows(world, player, "G A M E   O V E R"));
      tick(world, 100);
      EXPECT_TRUE(shows(world, player, "SPACE or P: play"));
      EXPECT_EQ(world.objects().objectsOfType("Hero").getCount(), 0);
      tap(world, player, df::Keyboard::SPACE);
      tick(world, 2);
      EXPECT_TRUE(shows(world, player, "ships 3"));
    });
  }
}

TEST(SaucerShoot, TeamPointsAreTheScoresPlusSeconds) {
  host(5, [](df::World& world) {
    const std::uint32_t player = joinAndFly(world);
    for (int t = 0; t < 300; ++t) {
      if (t % 10 == 0) tap(world, player, df::Keyboard::SPACE);
      world.tick();
    }
    EXPECT_GT(score(world, player), 0);
    const df::ObjectList points = world.objects().objectsOfType("Points");
    ASSERT_EQ(points.getCount(), 1);
    const int team = static_cast<const df::ViewObject*>(points[0])->getValue();
    EXPECT_EQ(team, score(world, player) + 10);  // 10 seconds give the team 10 points more
  });
}

TEST(SaucerShoot, TitleShowsHighScoresAndLastDeathAddsOne) {
  host(5, [](df::World& world) {
    for (const auto& [name, points] : {std::pair{"bob", 2000}, {"bob", 1000}, {"eve", 500}})
      world.input().push(
          {.kind = df::InputQueue::kScore, .player = 0, .name = name, .table = "pilots", .points = points});
    const std::uint32_t player = world.input().join("ann", df::RED);
    tick(world, 2);
    EXPECT_TRUE(shows(world, player, "Best pilots: bob 2000, eve 500")) << "each once";
    tap(world, player, df::Keyboard::P);
    tick(world, 2);
    EXPECT_FALSE(shows(world, player, "Best pilots"));
    world.views().player(player)->setScore(700);
    for (int ships = 2; ships >= 0; --ships) {
      tickInPeace(world, kShieldTicks);
      crash(world, player);
      EXPECT_EQ(df::HighScores("pilots").best().size(), ships == 0 ? 4u : 3u);
      if (ships > 0) tickInPeace(world, kRelaunchTicks);
    }
    world.tick();
    EXPECT_TRUE(shows(world, player, "Best pilots: bob 2000, ann 7"))
        << world.picture().renderPlayer(player).text();
  });
}

TEST(SaucerShoot, NukeClearsTheSkyAndEarnsNothing) {
  host(1, [](df::World& world) {
    const std::uint32_t player = joinAndFly(world);
    tick(world, 10);
    tap(world, player, df::Keyboard::RETURN);
    world.tick();
    const df::ObjectList saucers = world.objects().objectsOfType("Saucer");
    for (int i = 0; i < saucers.getCount(); ++i) EXPECT_GE(saucers[i]->getPosition().x(), 80);
    EXPECT_EQ(score(world, player), 0);
  });
}

}  // namespace
}  // namespace naiad
