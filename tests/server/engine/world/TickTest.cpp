// The order of the steps of a tick.
#include <memory>

#include "engine/events/EventStep.h"
#include "engine/world/Layer.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class NotingLayer : public Layer {
 public:
  explicit NotingLayer(Received& words) : m_words(words) {}
  void step(World& /*world*/) override { m_words.push_back("layer"); }

 private:
  Received& m_words;
};

class TickAlone : public WorldTest {
 protected:
  TickAlone() {
    probe.registerInterest(STEP_EVENT);
    probe.registerInterest(KEYBOARD_EVENT);
    probe.on_draw = [this](Probe&) { received.push_back("draw"); };
    world.addLayer(std::make_unique<NotingLayer>(received));
    ann = world.input().join("ann", RED);
    world.tick();
    received.clear();
  }

  Probe probe{"probe", &received};
  std::uint32_t ann = 0;
};

TEST_F(TickAlone, StagesRunInOrderAndPausedTickOnlyDraws) {
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  world.tick();
  EXPECT_EQ(received, (Received{"probe:df-step", "probe:df-keyboard", "layer", "draw"}));
  EXPECT_EQ(world.getStepCount(), 2);
  world.setPaused(true);
  received.clear();
  world.tick();
  EXPECT_EQ(received, Received{"draw"});
}

}  // namespace
}  // namespace df::test
