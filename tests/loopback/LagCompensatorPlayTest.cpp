// A click on what the player sees hits it, however far the server is and however fast the target moves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "FarServer.h"
#include "engine/events/EventMouse.h"
#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/Object.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
    return serveUntil(context, {&ann}, [&ann] {
      return ann.joined() && ann.session().hasDatagrams(Clock::now()) &&
             ann.session().counters().datagrams_in > 30;
    });
  }
  /// Serves ann until `count` clicks have reached the game; false after a timeout.
  bool clicked(TestClient& ann, std::size_t count, std::vector<Click>& now) {
    return serveUntil(context, {&ann}, [&] {
      now = server->inWorld([this](df::World&) { return clicks; });
      return now.size() >= count;
    });
  }

  std::vector<Click> clicks;  ///< used on the server's thread
};

TEST_F(LagCompensatorPlay, AClickHitsWhatWasOnTheScreen) {
  TestClient ann(context, proxy->port(), player("ann"));
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

}  // namespace
}  // namespace naiad::test
