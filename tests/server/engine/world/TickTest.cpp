#include <gtest/gtest.h>

#include <memory>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventStep.h"
#include "engine/world/Tick.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/engine/world/Parts.h"

namespace df::test {
namespace {

using Words = std::vector<std::string>;

class NotingLayer : public Layer {
 public:
  explicit NotingLayer(Words& words) : m_words(words) {}
  void step(World& /*world*/) override { m_words.push_back("layer"); }

 private:
  Words& m_words;
};

class TickAlone : public testing::Test {
 protected:
  TickAlone() {
    probe.registerInterest(STEP_EVENT);
    probe.registerInterest(KEYBOARD_EVENT);
    probe.on_draw = [this](Probe&) { words.push_back("draw"); };
    parts.state.layers.push_back(std::make_unique<NotingLayer>(words));
    ann = parts.input.join("ann", RED);
    parts.tick.run();
    words.clear();
  }

  Parts parts;
  Words words;
  Probe probe{"probe", &words};
  std::uint32_t ann = 0;
};

TEST_F(TickAlone, StepsAreInOrder) {
  parts.input.key(ann, Keyboard::A, KEY_PRESSED);
  parts.tick.run();
  EXPECT_EQ(words, (Words{"probe:df-step", "probe:df-keyboard", "layer", "draw"}));
  EXPECT_EQ(parts.state.step_count, 2);
}

TEST_F(TickAlone, PausedTickOnlyDraws) {
  parts.state.paused = true;
  parts.tick.run();
  EXPECT_EQ(words, Words{"draw"});
}

TEST_F(TickAlone, MarkedObjectsAreDeletedAfterTheLayers) {
  auto* p_other = new Probe;
  parts.objects.markForDelete(p_other);
  parts.tick.update();
  EXPECT_EQ(parts.store.countInWorld(), 1);
}

TEST_F(TickAlone, NestedTickDoesNothing) {
  probe.on_event = [this](Probe&, const Event&) { parts.tick.run(); };
  parts.tick.run();
  EXPECT_EQ(parts.state.step_count, 2);
  EXPECT_FALSE(parts.tick.isRunning());
}

}  // namespace
}  // namespace df::test
