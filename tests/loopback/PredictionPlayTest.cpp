// A key has a visible effect at once, however far the server is, and the prediction comes true.
#include <gtest/gtest.h>

#include "FarServer.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/Capture.h"
#include "engine/world/Controls.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Object.h"
#include "engine/world/Player.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
    return serveUntil(context, {&client}, [&] {
      if (!client.joined() || !client.session().hasDatagrams(Clock::now())) return false;
      client.session().predict(Clock::now());
      return client.session().isPredicting() && client.session().counters().datagrams_in > 30;
    });
  }
};

TEST_F(PredictionPlay, KeyShowsInTheNextFrameAndIsConfirmed) {
  TestClient ann(context, proxy->port(), player("ann"));
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
    ASSERT_TRUE(serveUntil(context, {&ann}, [&] {
      shown(ann);
      return ann.newestTick() >= tick + 4;
    }));
  }
  ASSERT_TRUE(serveUntil(context, {&ann}, [&] {
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

}  // namespace
}  // namespace naiad::test
