// Sprites over the wire: the client shows the frames of the animation, and a running animation sends nothing.
// Animations work as in the published engine (see AnimationTest).
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "DirectSender.h"
#include "SimulatedWorld.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/sprites/Sprite.h"
#include "engine/world/Capture.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace naiad {
namespace {

df::Sprite makeSprite(const std::vector<std::string>& frames, int width, int slowdown,
                      char transparency = 0) {
  df::Sprite sprite(static_cast<int>(frames.size()));
  sprite.setWidth(width);
  sprite.setHeight(static_cast<int>(frames.front().size()) / width);
  sprite.setSlowdown(slowdown);
  sprite.setTransparency(transparency);
  sprite.setColor(df::GREEN);
  for (const std::string& frame : frames) sprite.addFrame({width, sprite.getHeight(), frame});
  return sprite;
}

df::Sprite saucer(int slowdown) {
  return makeSprite({"~.-.~(o_o)", "~.-.~(_o_)", "~.-.~(__o)"}, 5, slowdown, '~');
}

void place(df::Object& object, df::Sprite& sprite, int x) {
  object.setSprite(&sprite);
  object.setPosition(df::Vector(x, 10));
}

class Show {
 public:
  Show() {
    world.log().setSink([](const std::string&) {});
    world.store().setWatched(true);
    m_player = world.input().join("ann", df::RED);
  }

  /// Runs `count` ticks, checks that the client shows the world's picture, and returns the bytes sent.
  std::size_t ticks(int count) {
    std::size_t bytes = 0;
    for (int i = 0; i < count && !testing::Test::HasFailure(); ++i) bytes += tick();
    return bytes;
  }

  char32_t shown(int x, int y) const {
    return m_reader.replica.render(static_cast<std::uint32_t>(world.getStepCount())).at(x, y).ch;
  }

  df::World world;
  df::World::Scope scope{world};

 private:
  std::size_t tick() {
    world.tick();
    m_publisher.update(world.picture().view());
    m_sender.applyTick(m_publisher, world.views().player(m_player)->facts());
    std::size_t bytes = 0;
    for (const SnapshotSender::Packet& packet : m_sender.build(m_publisher)) {
      m_reader.read(packet.bytes);
      bytes += packet.bytes.size();
    }
    m_sender.acknowledge(m_reader.acks);
    EXPECT_EQ(m_sender.known().checksum(), m_reader.replica.checksum());
    const df::Canvas wanted = world.picture().renderPlayer(m_player);
    const df::Canvas seen = m_reader.replica.render(static_cast<std::uint32_t>(world.getStepCount()));
    EXPECT_EQ(countDifferences(wanted, seen), 0) << "tick " << world.getStepCount() << "\n"
                                                 << test::explain(wanted, seen);
    return bytes;
  }

  std::uint32_t m_player = 0;
  Publisher m_publisher;
  SnapshotSender m_sender;
  test::SnapshotReader m_reader;
};

std::size_t idle(int count) {
  Show show;
  show.ticks(100);
  return show.ticks(count);
}

/// Returns the bytes of 300 ticks with 200 saucers in straight flight.
std::size_t flight(int slowdown) {
  Show show;
  df::Sprite sprite = saucer(slowdown);
  std::vector<std::unique_ptr<df::Object>> saucers;
  for (int i = 0; i < 200; ++i) {
    auto& p_o = saucers.emplace_back(std::make_unique<df::Object>());
    p_o->setSolidness(df::SPECTRAL);
    p_o->setSprite(&sprite);
    p_o->setSpriteIndex(slowdown == 0 ? 0 : i % 3);
    p_o->setPosition(df::Vector(53 + i % 25, 2 + i % 19 + 0.25 * (i % 3)));
    p_o->setVelocity(df::Vector(-0.125, 0));
  }
  show.ticks(100);  // until all saucers are published and fitted
  return show.ticks(300);
}

TEST(SpriteLook, TwoHundredAnimatedSaucersInFlightCostNothing) {
  const std::size_t animated = flight(4);
  EXPECT_EQ(animated, flight(0));
  EXPECT_EQ(animated, idle(300));
}

/// The published engine's frame counter: draw() shows a frame, then counts.
struct PublishedAnimation {
  int frames;
  int slowdown;
  int index = 0;
  int count = 0;

  int draw() {
    const int shown = index;
    if (count == -1 || slowdown == 0) return shown;
    if (++count >= slowdown) {
      count = 0;
      index = (index + 1) % frames;
    }
    return shown;
  }
};

TEST(SpriteLook, ClientShowsTheFramesOfThePublishedEngine) {
  for (const int slowdown : {0, 1, 2, 3, 5, 8}) {
    SCOPED_TRACE(slowdown);
    Show show;
    df::Sprite sprite = makeSprite({"a", "b", "c", "d"}, 1, slowdown);
    df::Object object;
    place(object, sprite, 20);
    PublishedAnimation published{4, slowdown};
    std::string wanted;
    std::string seen;
    for (int t = 0; t < 120; ++t) {
      if (t == 40) object.setSpriteIndex(published.index = 2);
      if (t == 61) object.setSpriteSlowdownCount(published.count = -1);
      if (t == 80) object.setSpriteSlowdownCount(published.count = 0);
      show.ticks(1);
      wanted += "abcd"[published.draw()];
      seen += static_cast<char>(show.shown(20, 10));
    }
    EXPECT_EQ(seen, wanted);
  }
}

TEST(SpriteLook, AnimationChangeShowsInTheSameTick) {
  Show show;
  df::Sprite sprite = saucer(4);
  df::Sprite other = makeSprite({"xx", "yy", "zz"}, 2, 2);
  df::Object object;
  place(object, sprite, 20);
  const std::vector<std::function<void()>> meddling = {
      [&] { object.setSpriteIndex(2); },
      [&] { object.setSpriteSlowdownCount(-1); },  // stops the animation
      [&] { object.setSpriteIndex(1); },
      [&] { object.setSpriteSlowdownCount(0); },  // continues the animation
      [&] { object.setSpriteSlowdownCount(99); },
      [&] { sprite.setSlowdown(0); },
      [&] { sprite.setSlowdown(3); },
      [&] { object.setTransparency('o'); },
      [&] { object.setTransparency('~'); },
      [&] { sprite.setColor(df::RED); },
      [&] { object.setSprite(&other); },
      [&] { object.setVisible(false); },
      [&] { object.setVisible(true); },
      [&] { object.setActive(false); },
      [&] { object.setActive(true); },
      [&] { object.setPosition(df::Vector(500, 10)); },  // the animation continues outside the view
      [&] { object.setPosition(df::Vector(30.5, 10)); },
      [&] { object.setStaticLook(); },
      [&] { object.setSprite(&sprite); },
      [&] { object.setShape(df::Shape()); },
      [&] { object.setSprite(nullptr); },
  };
  for (std::size_t i = 0; i < meddling.size(); ++i) {
    SCOPED_TRACE(i);
    show.ticks(9 + static_cast<int>(i) % 4);
    meddling[i]();
  }
  show.ticks(20);
}

TEST(SpriteLook, StoppedStaticBlinkingAndEmptySpritesCostNothing) {
  Show show;
  df::Sprite sprite = saucer(3);
  df::Sprite blinking = makeSprite({"abc", "~~~"}, 3, 3, '~');
  df::Sprite late = makeSprite({"~", "o", "~"}, 1, 2, '~');  // its first frame is empty
  df::Sprite empty = makeSprite({"~", "~"}, 1, 2, '~');
  df::Object stopped, fixed, blinks, begins_empty, draws_nothing;
  place(stopped, sprite, 20);
  place(fixed, sprite, 40);
  place(blinks, blinking, 50);
  place(begins_empty, late, 60);
  place(draws_nothing, empty, 70);
  fixed.setStaticLook();
  show.ticks(50);
  stopped.setSpriteSlowdownCount(-1);
  show.ticks(20);
  EXPECT_EQ(show.ticks(100), idle(100));
}

// A draw() that adds characters around the sprite.
TEST(SpriteLook, CharactersDrawnBesideTheSpriteAreShown) {
  Show show;
  struct Named : df::Object {
    int draw() override { return Object::draw() + DM.drawCh(getPosition() + df::Vector(0, -2), 'N'); }
  };
  df::Sprite sprite = saucer(3);
  Named object;
  place(object, sprite, 20);
  object.setVelocity(df::Vector(0.3, 0.1));
  show.ticks(60);
}

}  // namespace
}  // namespace naiad
