// Plays Saucer Shoot for the published engine without a screen, from the title to the next title.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Runner.h"
#include "World.h"
#include "WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

/// The game's main(), compiled into this test with another name.
int saucershoot2_main(int argc, char* argv[]);

namespace naiad {
namespace {

class SaucerShoot2 : public ::testing::Test, public df::Runner {
 protected:
  /// Runs the game from its start to its shutDown(). Calls `play` at the point where GM.run() would wait for
  /// players.
  void host(std::function<void()> play) {
    m_play = std::move(play);
    const df::World::Scope scope(world);
    world.log().setSink([this](const std::string& line) { log += line + "\n"; });
    world.extras().resources.addFolder(std::string(NAIAD_SOURCE_DIR) + "/tests/support/saucershoot2");
    world.setRunner(this);
    srand(1);
    EXPECT_EQ(saucershoot2_main(0, nullptr), 0);
    EXPECT_EQ(world.store().countInWorld(), 0);
  }
  void run(df::World& /*world*/) override { m_play(); }

  void press(df::Keyboard::Key key, df::EventKeyboardAction action = df::KEY_PRESSED) {
    df::EventKeyboard event;
    event.setKey(key);
    event.setKeyboardAction(action);
    WM.onEvent(&event);
  }
  void click(df::Vector at) {
    df::EventMouse event;
    event.setMouseAction(df::CLICKED);
    event.setMouseButton(df::Mouse::LEFT);
    event.setMousePosition(at);
    WM.onEvent(&event);
  }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i) world.tick();
  }
  int count(const char* type) const { return WM.objectsOfType(type).getCount(); }
  bool shows(const std::string& text) const {
    return world.picture().render({}).text().find(text) != std::string::npos;
  }

  df::World world;
  std::string log;

 private:
  std::function<void()> m_play;
};

TEST_F(SaucerShoot2, ShowsItsTitleAndStartsAtAKey) {
  host([this] {
    tick();
    EXPECT_TRUE(shows("P to play  Q to leave"));
    EXPECT_EQ(count("Star"), 16);
    EXPECT_EQ(count("Hero"), 0);
    press(df::Keyboard::P);
    tick();
    EXPECT_FALSE(shows("P to play"));
    EXPECT_TRUE(shows("| Points 0 |"));
    EXPECT_TRUE(shows("| Nukes 1 |"));
    EXPECT_TRUE(shows(">=##=>"));
    EXPECT_EQ(count("Hero"), 1);
    EXPECT_EQ(count("Saucer"), 16);
  });
  EXPECT_EQ(log.find("Sprite"), std::string::npos) << log;
}

TEST_F(SaucerShoot2, HeldKeyMovesTheShipAndMouseFires) {
  host([this] {
    press(df::Keyboard::P);
    const df::Object* p_hero = WM.objectsOfType("Hero")[0];
    const double y = p_hero->getPosition().y();
    for (int i = 0; i < 6; ++i) {
      press(df::Keyboard::W, df::KEY_DOWN);
      tick();
    }
    EXPECT_EQ(p_hero->getPosition().y(), y - 2);  // one row in every second tick, from the third tick on
    tick(15);
    click(p_hero->getPosition() + df::Vector(20, 0));
    EXPECT_EQ(count("Bullet"), 1);
    click(p_hero->getPosition() + df::Vector(20, 0));
    EXPECT_EQ(count("Bullet"), 1);  // the gun is not ready yet
    tick(100);
    EXPECT_EQ(count("Bullet"), 0);  // the bullet has left the world or hit something
  });
}

TEST_F(SaucerShoot2, ShotSaucerExplodesForTenPointsAndIsReplaced) {
  host([this] {
    press(df::Keyboard::P);
    tick(20);
    df::Object* p_hero = WM.objectsOfType("Hero")[0];
    df::Object* p_saucer = WM.objectsOfType("Saucer")[0];
    p_saucer->setPosition(p_hero->getPosition() + df::Vector(20, 0));
    click(p_saucer->getPosition());
    tick(14);
    EXPECT_EQ(count("Explosion"), 1);
    EXPECT_EQ(count("Saucer"), 16);
    EXPECT_TRUE(shows("| Points 11 |")) << world.picture().render({}).text();
    tick(12);
    EXPECT_EQ(count("Explosion"), 0);
  });
}

TEST_F(SaucerShoot2, ANukeClearsTheSky) {
  host([this] {
    press(df::Keyboard::P);
    tick();
    press(df::Keyboard::SPACE);
    tick();
    EXPECT_TRUE(shows("| Nukes 0 |"));
    EXPECT_EQ(count("Explosion"), 16);
    EXPECT_EQ(count("Saucer"), 16);
    press(df::Keyboard::SPACE);
    tick();
    EXPECT_TRUE(shows("| Nukes 0 |"));
  });
}

TEST_F(SaucerShoot2, HitShipEndsTheRoundAndShowsTheTitle) {
  host([this] {
    for (int round = 0; round < 2; ++round) {
      press(df::Keyboard::P);
      tick();
      df::Object* p_hero = WM.objectsOfType("Hero")[0];
      ASSERT_NE(p_hero, nullptr);
      WM.objectsOfType("Saucer")[0]->setPosition(p_hero->getPosition() + df::Vector(5.6, 0));
      tick(3);
      EXPECT_EQ(count("Hero"), 0);
      EXPECT_EQ(count("Reticle"), 0);
      EXPECT_TRUE(shows("G A M E  O V E R"));
      tick(65);
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
