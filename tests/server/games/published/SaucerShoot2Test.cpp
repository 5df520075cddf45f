// Plays Saucer Shoot for the published engine without a screen, from the title to the next title.

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "EventMouse.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/games/HostedGame.h"

/// The game's main(), compiled into this test with another name.
int saucershoot2_main(int argc, char* argv[]);

namespace naiad {
namespace {

class SaucerShoot2 : public df::test::WorldTest {
 protected:
  /// Runs the game from its start to its shutDown(). Calls `play` where GM.run() would wait for players.
  void host(const std::function<void()>& play) {
    world.extras().resources.addFolder(std::string(NAIAD_SOURCE_DIR) + "/tests/support/saucershoot2");
    TestRunner runner([&play](df::World&) { play(); });
    world.setRunner(&runner);
    srand(1);
    EXPECT_EQ(saucershoot2_main(0, nullptr), 0);
    world.setRunner(nullptr);
    EXPECT_EQ(world.store().countInWorld(), 0);
  }
  void click(df::Vector at) {
    df::EventMouse event;
    event.setMouseAction(df::CLICKED);
    event.setMouseButton(df::Mouse::LEFT);
    event.setMousePosition(at);
    WM.onEvent(&event);
  }
  int count(const char* type) const { return WM.objectsOfType(type).getCount(); }
  bool shows(const std::string& text) const {
    return world.picture().render({}).text().find(text) != std::string::npos;
  }
};

TEST_F(SaucerShoot2, ShowsItsTitleAndStartsAtAKey) {
  host([this] {
    ticks(1);
    EXPECT_TRUE(shows("P to play  Q to leave"));
    EXPECT_EQ(count("Star"), 16);
    EXPECT_EQ(count("Hero"), 0);
    press(df::Keyboard::P);
    ticks(1);
    EXPECT_FALSE(shows("P to play"));
    EXPECT_TRUE(shows("| Points 0 |"));
    EXPECT_TRUE(shows("| Nukes 1 |"));
    EXPECT_TRUE(shows(">=##=>"));
    EXPECT_EQ(count("Hero"), 1);
    EXPECT_EQ(count("Saucer"), 16);
  });
  EXPECT_EQ(logged("Sprite"), 0);
}

TEST_F(SaucerShoot2, HeldKeyMovesTheShipAndMouseFires) {
  host([this] {
    press(df::Keyboard::P);
    const df::Object* p_hero = WM.objectsOfType("Hero")[0];
    const double y = p_hero->getPosition().y();
    for (int i = 0; i < 6; ++i) {
      press(df::Keyboard::W, df::KEY_DOWN);
      ticks(1);
    }
    EXPECT_EQ(p_hero->getPosition().y(), y - 2);  // one row in every second tick, from the third tick on
    ticks(15);
    click(p_hero->getPosition() + df::Vector(20, 0));
    EXPECT_EQ(count("Bullet"), 1);
    click(p_hero->getPosition() + df::Vector(20, 0));
    EXPECT_EQ(count("Bullet"), 1);  // the gun is not ready yet
    ticks(100);
    EXPECT_EQ(count("Bullet"), 0);  // the bullet has left the world or hit something
  });
}

TEST_F(SaucerShoot2, ShotSaucerExplodesForTenPointsAndIsReplaced) {
  host([this] {
    press(df::Keyboard::P);
    ticks(20);
    df::Object* p_hero = WM.objectsOfType("Hero")[0];
    df::Object* p_saucer = WM.objectsOfType("Saucer")[0];
    p_saucer->setPosition(p_hero->getPosition() + df::Vector(20, 0));
    click(p_saucer->getPosition());
    ticks(14);
    EXPECT_EQ(count("Explosion"), 1);
    EXPECT_EQ(count("Saucer"), 16);
    EXPECT_TRUE(shows("| Points 11 |")) << world.picture().render({}).text();
    ticks(12);
    EXPECT_EQ(count("Explosion"), 0);
  });
}

TEST_F(SaucerShoot2, ANukeClearsTheSky) {
  host([this] {
    press(df::Keyboard::P);
    ticks(1);
    press(df::Keyboard::SPACE);
    ticks(1);
    EXPECT_TRUE(shows("| Nukes 0 |"));
    EXPECT_EQ(count("Explosion"), 16);
    EXPECT_EQ(count("Saucer"), 16);
    press(df::Keyboard::SPACE);
    ticks(1);
    EXPECT_TRUE(shows("| Nukes 0 |"));
  });
}

TEST_F(SaucerShoot2, HitShipEndsTheRoundAndShowsTheTitle) {
  host([this] {
    for (int round = 0; round < 2; ++round) {
      press(df::Keyboard::P);
      ticks(1);
      df::Object* p_hero = WM.objectsOfType("Hero")[0];
      ASSERT_NE(p_hero, nullptr);
      WM.objectsOfType("Saucer")[0]->setPosition(p_hero->getPosition() + df::Vector(5.6, 0));
      ticks(3);
      EXPECT_EQ(count("Hero"), 0);
      EXPECT_EQ(count("Reticle"), 0);
      EXPECT_TRUE(shows("G A M E  O V E R"));
      ticks(65);
      EXPECT_TRUE(shows("P to play"));
      EXPECT_EQ(count("Saucer"), 0);
      EXPECT_FALSE(shows("Points"));
    }
    press(df::Keyboard::Q);
    EXPECT_TRUE(world.isGameOver());
  });
}

}  // namespace
}  // namespace naiad
