#include <memory>

#include "engine/events/EventStep.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Interests : public WorldTest {
 protected:
  Event named(const std::string& type) {
    Event event;
    event.setType(type);
    return event;
  }
  Event ping = named("ping");
};

TEST_F(Interests, EventsAreSentInRegistrationOrder) {
  Probe a("a", &received);
  Probe b("b", &received);
  Probe c("c", &received);
  c.registerInterest("ping");
  a.registerInterest("ping");
  EXPECT_EQ(WM.onEvent(&ping), 2);
  EXPECT_EQ(received, (Received{"c:ping", "a:ping"}));
  EXPECT_EQ(WM.onEvent(nullptr), 0);
}

TEST_F(Interests, RegisteringTwiceCountsOnceUntilUnregistered) {
  Probe a("a", &received);
  EXPECT_EQ(a.registerInterest("ping"), 0);
  EXPECT_EQ(a.registerInterest("ping"), 0);
  EXPECT_EQ(WM.onEvent(&ping), 1);
  EXPECT_EQ(a.unregisterInterest("ping"), 0);
  EXPECT_EQ(a.unregisterInterest("ping"), -1);
  EXPECT_EQ(a.unregisterInterest("never"), -1);
  EXPECT_EQ(WM.onEvent(&ping), 0);
}

TEST_F(Interests, InactiveObjectsGetNoEvents) {
  Probe a("a", &received);
  a.registerInterest("ping");
  a.setActive(false);
  EXPECT_EQ(WM.onEvent(&ping), 0);
  a.setActive(true);
  EXPECT_EQ(WM.onEvent(&ping), 1);
}

TEST_F(Interests, NewListenersWaitAndDeletedOnesAreSkipped) {
  auto* p_a = new Probe("a", &received);
  auto* p_b = new Probe("b", &received);
  auto* p_c = new Probe("c", &received);
  for (Probe* p : {p_a, p_b, p_c}) p->registerInterest("ping");
  p_a->on_event = [&](Probe&, const Event&) {
    delete std::exchange(p_b, nullptr);
    (new Probe("late", &received))->registerInterest("ping");
  };
  EXPECT_EQ(WM.onEvent(&ping), 2);
  EXPECT_EQ(received, (Received{"a:ping", "c:ping"}));
}

TEST_F(Interests, HandlerMayDeleteItselfAndSendMore) {
  auto* p_a = new Probe("a", &received);
  Probe b("b", &received);
  p_a->registerInterest("ping");
  b.registerInterest("pong");
  p_a->on_event = [&](Probe& self, const Event&) {
    const Event pong = named("pong");
    WM.onEvent(&pong);
    delete &self;
  };
  WM.onEvent(&ping);
  EXPECT_EQ(received, (Received{"a:ping", "b:pong"}));
  EXPECT_EQ(WM.onEvent(&ping), 0);
}

TEST_F(Interests, ReinsertedObjectHasLostItsInterests) {
  Probe a("a", &received);
  a.registerInterest("ping");
  WM.removeObject(&a);
  EXPECT_EQ(a.registerInterest("ping"), -1);
  WM.insertObject(&a);
  EXPECT_EQ(WM.onEvent(&ping), 0);
}

TEST_F(Interests, OrderSurvivesManyDeletionsAndUnregistrations) {
  std::vector<std::unique_ptr<Probe>> probes;
  for (int i = 0; i < 200; ++i) {
    probes.push_back(std::make_unique<Probe>(std::to_string(i), &received));
    probes.back()->registerInterest("ping");
  }
  Received expected;
  for (int i = 0; i < 200; ++i) {
    if (i % 3 == 0) {
      probes[i].reset();
    } else if (i % 3 == 1) {
      probes[i]->unregisterInterest("ping");
    } else {
      expected.push_back(std::to_string(i) + ":ping");
    }
  }
  WM.onEvent(&ping);
  EXPECT_EQ(received, expected);
}

TEST_F(Interests, ThrowingHandlerIsQuarantinedAndTheTickContinues) {
  auto* p_bad = new Probe("bad", &received);
  Probe good("good", &received);
  p_bad->registerInterest(STEP_EVENT);
  good.registerInterest(STEP_EVENT);
  p_bad->on_event = [](Probe&, const Event&) { throw 42; };
  ticks(2);
  EXPECT_EQ(received, (Received{"bad:df-step", "good:df-step", "good:df-step"}));
  EXPECT_EQ(logged("bad"), 1);
  EXPECT_EQ(world.store().countInWorld(), 1);
}

}  // namespace
}  // namespace df::test
