#include <gtest/gtest.h>

#include <stdexcept>

#include "engine/events/EventStep.h"
#include "engine/world/EventDispatch.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/engine/world/Parts.h"

namespace df::test {
namespace {

TEST(EventDispatch, PausedWorldSendsJoinsAlone) {
  Parts parts;
  std::vector<std::string> received;
  Probe probe("probe", &received);
  probe.registerInterest(STEP_EVENT);
  probe.registerInterest(JOIN_EVENT);
  parts.state.paused = true;
  const EventStep step;
  const EventJoin join(1);
  EXPECT_EQ(parts.events.onEvent(&step), 0);
  EXPECT_EQ(parts.events.onEvent(&join), 1);
  EXPECT_EQ(parts.events.sendToAll(step), 1);
  EXPECT_EQ(received, (std::vector<std::string>{"probe:df-join", "probe:df-step"}));
}

TEST(EventDispatch, ThrowingHandlerMarksItsObject) {
  Parts parts;
  auto* p_probe = new Probe("thrower");
  p_probe->on_event = [](Probe&, const Event&) { throw std::runtime_error("boom"); };
  EXPECT_TRUE(parts.events.deliver(p_probe->key(), EventStep()));
  EXPECT_FALSE(p_probe->isActive());
  EXPECT_FALSE(parts.events.isRunning());
  ASSERT_EQ(parts.lines.size(), 1u);
  EXPECT_NE(parts.lines[0].find("boom"), std::string::npos);
  parts.objects.deleteMarked();
  EXPECT_EQ(parts.store.countInWorld(), 0);
}

TEST(EventDispatch, PendingShutdownFollowsTheHandler) {
  Parts parts;
  Probe probe;
  probe.on_event = [&](Probe&, const Event&) {
    EXPECT_TRUE(parts.events.isRunning());
    parts.events.deferShutDown();
    EXPECT_EQ(parts.shutdowns, 0);
  };
  parts.events.deliver(probe.key(), EventStep());
  EXPECT_EQ(parts.shutdowns, 1);
  EXPECT_TRUE(parts.events.takeShutDown());
  probe.on_event = nullptr;
  parts.events.deliver(probe.key(), EventStep());
  EXPECT_EQ(parts.shutdowns, 1);
}

}  // namespace
}  // namespace df::test
