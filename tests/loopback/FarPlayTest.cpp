// Play on a server at 30 Hz that is 50 ms away in each direction: a key has a visible effect at once and the
// prediction comes true; a click hits what the player sees, however fast the target moves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "LoopbackFixture.h"
#include "StreamProxy.h"
#include "engine/events/EventMouse.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/Controls.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

class FarServer : public LoopbackFixture {
 protected:
  void start(std::function<void(df::World&)> populate) {
    HostOptions options = home.server();
    options.frame_micros = 0;  // 30 Hz, the default
    server = std::make_unique<TestServer>(std::move(populate), options);
    proxy = std::make_unique<StreamProxy>(context, server->port());
    proxy->setDelay(std::chrono::milliseconds(50));
    valve->delay = std::chrono::milliseconds(50);
    valve->server_port = server->port();
  }

  std::unique_ptr<TestServer> server;
  std::unique_ptr<StreamProxy> proxy;
};

// ---- prediction -------------------------------------------------------------------------------------------

/// Gives each player a boat with declared controls.
class Boatyard : public df::Object {
 public:
  Boatyard() {
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::JOIN_EVENT) return 0;
    df::Player* p_player = WM.getPlayer(dynamic_cast<const df::EventJoin*>(p_e)->getPlayer());
    auto* p_boat = new df::Object;
    p_boat->setType("Boat");
    p_boat->setPosition(df::Vector(40, 12));
    p_player->setObject(p_boat);
    p_player->setControls(
        df::Controls().onKey(df::Keyboard::RIGHTARROW).step(1, 0).onKey(df::Keyboard::LEFTARROW).step(-1, 0));
    return 1;
  }
};

class PredictionPlay : public FarServer {
 protected:
  PredictionPlay() {
    start([](df::World&) { new Boatyard; });
  }
  static df::FixedVector shown(TestClient& client) {
    return client.session().predict(Clock::now()).position();
  }
  df::FixedVector real() {
    return server->inWorld(
        [](df::World& world) { return world.picture().view().players.at(0).steering.position; });
  }
  bool isPredicting(TestClient& client) {
    return serve(client, [&] {
      if (!isOnDatagrams(client)) return false;
      client.session().predict(Clock::now());
      return client.session().isPredicting() && client.session().counters().datagrams_in > 30;
    });
  }
};

TEST_F(PredictionPlay, KeyShowsInTheNextFrameAndIsConfirmed) {
  TestClient ann(context, proxy->port(), playerWithValve("ann"));
  ASSERT_TRUE(isPredicting(ann));
  const df::FixedVector start = shown(ann);
  EXPECT_EQ(start, real());
  int x = 0;
  for (int i = 0; i < 20; ++i) {
    const bool right = i % 5 < 3;
    const auto key = right ? df::Keyboard::RIGHTARROW : df::Keyboard::LEFTARROW;
    ASSERT_TRUE(ann.session().sendKey(key, df::KEY_PRESSED, Clock::now()));
    x += right ? 1 : -1;
    // The server's answer cannot have arrived yet, so the boat's move was predicted.
    EXPECT_EQ(shown(ann), (start + df::FixedVector{df::fromCells(x), 0})) << i;
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serve(ann, [&] {
      shown(ann);
      return ann.newestTick() >= tick + 4;
    }));
  }
  ASSERT_TRUE(serve(ann, [&] {
    shown(ann);
    return ann.session().predict(Clock::now()).pendingInputs() == 0;
  }));
  EXPECT_EQ(shown(ann), real());
  EXPECT_EQ(real(), (start + df::FixedVector{df::fromCells(x), 0}));
  const Prediction::Counters& counters = ann.session().predict(Clock::now()).counters();
  EXPECT_EQ(counters.unpredicted, 0u);
  EXPECT_GE(counters.confirmed, 10u);
  // No obstacle is near, so only a key that arrived too late may have been mispredicted.
  const bool none_late = ann.session().inputTickEstimator().margin() == InputTickEstimator::kMinMargin;
  EXPECT_TRUE(counters.mispredicted == 0 || !none_late) << counters.mispredicted;
  std::printf("confirmed=%d mispredicted=%d margin=%.2f\n", static_cast<int>(counters.confirmed),
              static_cast<int>(counters.mispredicted), ann.session().inputTickEstimator().margin());
}

// ---- clicks -----------------------------------------------------------------------------------------------

constexpr int kSlow = 12;  ///< row of the target that moves half a cell a tick
constexpr int kFast = 14;  ///< row of the target that moves a cell a tick
/// Limit of clicks in a test. It is high because on a busy machine most clicks arrive too late to be
/// compensated.
constexpr std::size_t kMaxClicks = 100;

struct Click {
  std::uint32_t tick = 0;  ///< last tick before the one that handled the click
  bool hit_as_drawn = false;
  bool hit_now = false;
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

class LagCompensatorPlay : public FarServer {
 protected:
  LagCompensatorPlay() {
    start([this](df::World&) {
      new Target(clicks, kSlow, 0.5);
      new Target(clicks, kFast, 1);
      WM.setLagCompensated();
    });
  }
  ~LagCompensatorPlay() override { server.reset(); }  // the server adds to `clicks`, so it must end first
  bool plays(TestClient& ann) {
    return serve(ann, [&ann] { return isOnDatagrams(ann) && ann.session().counters().datagrams_in > 30; });
  }
  /// Serves ann until `count` clicks have reached the game; false after a timeout.
  bool clicked(TestClient& ann, std::size_t count, std::vector<Click>& now) {
    return serve(ann, [&] {
      now = server->inWorld([this](df::World&) { return clicks; });
      return now.size() >= count;
    });
  }

  std::vector<Click> clicks;  ///< used on the server's thread
};

TEST_F(LagCompensatorPlay, AClickHitsWhatWasOnTheScreen) {
  TestClient ann(context, proxy->port(), playerWithValve("ann"));
  ASSERT_TRUE(plays(ann));
  int judged = 0;
  int fast = 0;
  int hits_now = 0;  ///< clicks on the fast target that would also hit without compensation
  for (std::size_t i = 0; judged < 30 && i < kMaxClicks; ++i) {
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serve(ann, [&] { return ann.newestTick() >= tick + 3; }));
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

}  // namespace
}  // namespace naiad::test
