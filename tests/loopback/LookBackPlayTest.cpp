// Who clicks on what he sees hits it, however far the server is and however fast the target.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "DisplayManager.h"
#include "EventMouse.h"
#include "EventStep.h"
#include "Home.h"
#include "Object.h"
#include "StreamProxy.h"
#include "TestServer.h"
#include "Valve.h"
#include "WorldManager.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int kSlow = 12;  ///< the row of a target that flies half a cell a tick
constexpr int kFast = 14;  ///< … a cell a tick

struct Click {
  std::uint32_t tick = 0;  ///< the one before that which took it in
  bool hit_as_drawn = false;
  bool hit_now = false;
};

/// A character that flies to and fro in its row, and notes what clicks in that row hit.
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
    click.tick = df::World::current().view().tick;
    click.hit_as_drawn = WM.objectsSeenAt(cell).getCount() > 0;
    click.hit_now = std::abs(getPosition().getX() - cell.getX()) <= 0.5;
    m_clicks.push_back(click);
    return 1;
  }

 private:
  std::vector<Click>& m_clicks;
  double m_speed;
};

class LookBackPlay : public testing::Test {
 protected:
  LookBackPlay() : proxy(context, server.port()) {
    valve->delay = 50ms;
    valve->server_port = server.port();
    proxy.setDelay(50ms);
  }
  HostOptions options() const {
    HostOptions options = home.server();
    options.frame_micros = 0;  // 30 Hz, as people play
    return options;
  }

  Home home;
  std::vector<Click> clicks;  ///< the server's thread's
  asio::io_context context;
  std::shared_ptr<Valve> valve = std::make_shared<Valve>();
  TestServer server{[this](df::World&) {
                      new Target(clicks, kSlow, 0.5);
                      new Target(clicks, kFast, 1);
                      WM.setLookingBack();
                    },
                    options()};
  StreamProxy proxy;
};

TEST_F(LookBackPlay, AClickHitsWhatWasOnTheScreen) {
  ClientSetup setup = home.player("ann");
  setup.options.open_socket = through(context, valve);
  TestClient ann(context, proxy.port(), setup);
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] {
    return ann.joined() && ann.session().hasDatagrams(Clock::now()) &&
           ann.session().counters().datagrams_in > 30;
  }));
  int judged = 0;
  int fast = 0;
  int hits_now = 0;  ///< on the fast one, had nobody looked back
  for (std::size_t i = 0; i < 80 && judged < 30; ++i) {
    const std::uint32_t tick = ann.newestTick();
    ASSERT_TRUE(serveUntil(context, {&ann}, [&] { return ann.newestTick() >= tick + 3; }));
    const int row = i % 2 == 0 ? kSlow : kFast;
    const std::uint32_t drawn = ann.session().displayTick(Clock::now());
    const df::Canvas picture = ann.session().replica().render(drawn);
    int x = 0;
    while (x < 80 && picture.at(x, row).ch != '#') ++x;
    ASSERT_LT(x, 80);
    ASSERT_TRUE(ann.session().sendMouse(df::CLICKED, df::Mouse::LEFT, x, row, Clock::now()));
    std::vector<Click> now;
    ASSERT_TRUE(serveUntil(context, {&ann}, [&] {
      now = server.inWorld([this](df::World&) { return clicks; });
      return now.size() > i;
    }));
    // On a machine that is too busy the click comes later than anybody looks back.
    const Click& click = now.back();
    if (click.tick - drawn > LookBack::kMostBehind) continue;
    ++judged;
    EXPECT_TRUE(click.hit_as_drawn) << "click " << i << ", drawn " << drawn << ", taken in after "
                                    << click.tick;
    if (row != kFast) continue;
    ++fast;
    hits_now += click.hit_now ? 1 : 0;
  }
  EXPECT_GE(fast, 5);
  EXPECT_LE(2 * hits_now, fast) << "it is elsewhere by then";
  std::printf("judged=%d fast=%d hits_now=%d\n", judged, fast, hits_now);
}

}  // namespace
}  // namespace naiad::test
