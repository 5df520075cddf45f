// A click on what the player sees hits it, however far the server is and however fast the target moves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "Home.h"
#include "StreamProxy.h"
#include "TestServer.h"
#include "Valve.h"
#include "engine/events/EventMouse.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kSlow = 12;     ///< row of the target that moves half a cell a tick
constexpr int kFast = 14;     ///< row of the target that moves a cell a tick
constexpr int kPillars = 16;  ///< row of the fixed pillars in a wide world
/// Limit of clicks in a test. It is high because on a busy machine most clicks arrive too late to be
/// compensated.
constexpr std::size_t kMaxClicks = 100;

struct Click {
  std::uint32_t tick = 0;  ///< last tick before the one that handled the click
  bool hit_as_drawn = false;
  bool hit_now = false;
  double corner = 0;  ///< left edge of the scrolling view at that tick
};

/// A character that moves back and forth in its row, and records whether clicks in that row hit.
class Target : public df::Object {
 public:
  Target(std::vector<Click>& clicks, int row, double speed) : m_clicks(clicks), m_speed(speed) {
    setType("Target");
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(10, row));
    setVelocity(df::Vector(speed, 0));
    registerInterest(df::MSE_EVENT);
    registerInterest(df::STEP_EVENT);
  }
  int draw() override { return DM.drawCh(getPosition(), '#', df::RED); }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::STEP_EVENT) {
      if (getPosition().getX() >= 70) setVelocity(df::Vector(-m_speed, 0));
      if (getPosition().getX() <= 10) setVelocity(df::Vector(m_speed, 0));
      return 1;
    }
    const auto* p_mouse = dynamic_cast<const df::EventMouse*>(p_e);
    if (p_mouse == nullptr || p_mouse->getMouseAction() != df::CLICKED) return 0;
    const df::Vector cell = p_mouse->getMousePosition();
    if (std::abs(cell.getY() - getPosition().getY()) > 0.5) return 0;
    Click click;
    click.tick = df::World::current().picture().view().tick;
    click.hit_as_drawn = WM.objectsSeenAt(cell).getCount() > 0;
    click.hit_now = std::abs(getPosition().getX() - cell.getX()) <= 0.5;
    m_clicks.push_back(click);
    return 1;
  }

 private:
  std::vector<Click>& m_clicks;
  double m_speed;
};

/// Moves to the right, followed by its player's view.
struct Runner : df::Object {
  Runner() {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(60, 12));
    setVelocity(df::Vector(1, 0));
  }
  int draw() override { return DM.drawCh(getPosition(), '@', df::CYAN); }
};

struct Pillar : df::Object {
  explicit Pillar(int x) {
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(x, kPillars));
  }
  int draw() override { return DM.drawCh(getPosition(), '#', df::RED); }
};

/// Gives each player a Runner, and records whether clicks hit anything.
class Watcher : public df::Object {
 public:
  explicit Watcher(std::vector<Click>& clicks) : m_clicks(clicks) {
    setSolidness(df::SPECTRAL);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::MSE_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e)) {
      m_p_runner = new Runner;
      WM.getPlayer(p_join->getPlayer())->setObject(m_p_runner);
      return 1;
    }
    const auto* p_mouse = dynamic_cast<const df::EventMouse*>(p_e);
    if (p_mouse == nullptr || p_mouse->getMouseAction() != df::CLICKED) return 0;
    Click click;
    click.tick = df::World::current().picture().view().tick;
    click.hit_as_drawn = WM.objectsSeenAt(p_mouse->getMousePosition()).getCount() > 0;
    click.corner = m_p_runner->getPosition().getX() - 80 * 2 / 3.0;  // it pushes the view
    m_clicks.push_back(click);
    return 1;
  }

 private:
  std::vector<Click>& m_clicks;
  Runner* m_p_runner = nullptr;
};

class LagCompensatorPlay : public testing::Test {
 protected:
  LagCompensatorPlay()
      : LagCompensatorPlay([this] {
          new Target(clicks, kSlow, 0.5);
          new Target(clicks, kFast, 1);
        }) {}
  explicit LagCompensatorPlay(const std::function<void()>& populate)
      : server(
            [populate](df::World&) {
              populate();
              WM.setLagCompensated();
            },
            options()),
        proxy(context, server.port()) {
    valve->delay = 50ms;
    valve->server_port = server.port();
    proxy.setDelay(50ms);
  }
  HostOptions options() const {
    HostOptions options = home.server();
    options.frame_micros = 0;  // 30 Hz, the default
    return options;
  }

  Home home;
  std::vector<Click> clicks;  ///< used on the server's thread
  asio::io_context context;
  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
  TestServer server;
  StreamProxy proxy;

  ClientSetup annsSetup() {
    ClientSetup setup = home.player("ann");
    setup.options.open_socket = through(context, valve);
    return setup;
  }
  bool plays(TestClient& ann) {
    return serveUntil(context, {&ann}, [&ann] {
      return ann.joined() && ann.session().hasDatagrams(Clock::now()) &&
             ann.session().counters().datagrams_in > 30;
    });
  }
  /// Serves ann until `count` clicks have reached the game; false after a timeout.
  bool clicked(TestClient& ann, std::size_t count, std::vector<Click>& now) {
    return serveUntil(context, {&ann}, [&] {
      now = server.inWorld([this](df::World&) { return clicks; });
      return now.size() >= count;
    });
  }
};

TEST_F(LagCompensatorPlay, AClickHitsWhatWasOnTheScreen) {
  TestClient ann(context, proxy.port(), annsSetup());
  ASSERT_TRUE(plays(ann));
  int judged = 0;
  int fast = 0;
  int hits_now = 0;  ///< clicks on the fast target that would also hit without compensation
  for (std::size_t i = 0; judged < 30 && i < kMaxClicks; ++i) {
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.newestTick() >= tick + 3; }));
    const int row = i % 2 == 0 ? kSlow : kFast;
    const auto present = Clock::now();  // time of the picture and of the click in it
    const std::uint32_t drawn = ann.session().displayTick(present);
    const df::Canvas picture = ann.session().replica().render(drawn);
    int x = 0;
    while (x < 80 && picture.at(x, row).ch != '#') ++x;
    ASSERT_LT(x, 80);
    ASSERT_TRUE(ann.session().sendMouse(df::CLICKED, df::Mouse::LEFT, x, row, present));
    std::vector<Click> now;
    ASSERT_TRUE(clicked(ann, i + 1, now));
    // A click may arrive too late to be compensated if the machine is busy.
    const Click& click = now.back();
    if (click.tick - drawn > LagCompensator::kMaxBehind) continue;
    ++judged;
    EXPECT_TRUE(click.hit_as_drawn) << "click " << i << ", drawn " << drawn << ", taken in after "
                                    << click.tick;
    if (row != kFast) continue;
    ++fast;
    hits_now += click.hit_now ? 1 : 0;
  }
  EXPECT_GT(judged, 0);
  if (fast >= 5) {
    EXPECT_LE(2 * hits_now, fast) << "it is elsewhere by then";
  }
  std::printf("judged=%d fast=%d hits_now=%d\n", judged, fast, hits_now);
}

class LagCompensatorScrolling : public LagCompensatorPlay {
 protected:
  static constexpr int kWidth = 6000;

  LagCompensatorScrolling()
      : LagCompensatorPlay([this] {
          WM.setBoundary(df::Box(df::Vector(), kWidth, 24));
          new Watcher(clicks);
          for (int x = 0; x < kWidth; x += 15) new Pillar(x);
        }) {}
};

TEST_F(LagCompensatorScrolling, AClickHitsWhatWasOnTheScreen) {
  TestClient ann(context, proxy.port(), annsSetup());
  ASSERT_TRUE(plays(ann));
  int judged = 0;
  const std::uint32_t last_tick = kWidth - 500;  // the runner moves a cell a tick
  for (std::size_t i = 0; judged < 15 && i < kMaxClicks && ann.newestTick() < last_tick; ++i) {
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.newestTick() >= tick + 3; }));
    const Replica& replica = ann.session().replica();
    const auto present = Clock::now();  // time of the picture and of the click in it
    const std::uint32_t drawn = ann.session().displayTick(present);
    const df::Canvas picture = replica.render(drawn);
    const std::int32_t corner = replica.viewCorner(drawn).x;
    int x = 20;
    while (x < 60 && picture.at(x, kPillars).ch != '#') ++x;
    ASSERT_LT(x, 60);
    ASSERT_TRUE(ann.session().sendMouse(df::CLICKED, df::Mouse::LEFT, x, kPillars, present));
    std::vector<Click> now;
    ASSERT_TRUE(clicked(ann, i + 1, now));
    // A click may arrive too late to be compensated if the machine is busy. If the server is behind
    // the picture, the client drew a predicted view.
    const auto behind = static_cast<std::int32_t>(now.back().tick - drawn);
    if (behind < 2 || behind > static_cast<std::int32_t>(LagCompensator::kMaxBehind)) continue;
    EXPECT_GT(now.back().corner, corner + 0.5) << "the view has not gone on";
    ++judged;
    EXPECT_TRUE(now.back().hit_as_drawn)
        << "click " << i << ", drawn " << drawn << ", taken in after " << now.back().tick;
  }
  EXPECT_GT(judged, 0);
  std::printf("judged=%d\n", judged);
}

}  // namespace
}  // namespace naiad::test
