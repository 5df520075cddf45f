// Default values of Objects and widgets: by the book and, in compat mode, of the published engine.

#include <array>
#include <cstring>
#include <memory>

#include "engine/events/EventView.h"
#include "engine/widgets/Button.h"
#include "engine/widgets/Pause.h"
#include "engine/widgets/TextEntry.h"
#include "engine/world/Geometry.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Press : public Button {
 public:
  void callback() override {}
};

class Entry : public TextEntry {
 public:
  void callback() override {}
};

/// A class whose constructor does not initialise its members.
class Careless : public Object {
 public:
  Careless() {}  // NOLINT(modernize-use-equals-default): `= default` would clear them
  Object* p_target;
  int lives;
  std::array<unsigned char, 200> rest;
};

using CompatDefaults = WorldTest;

TEST_F(CompatDefaults, ObjectsStartAtOneOneWithoutAType) {
  const Object by_the_book;
  EXPECT_EQ(by_the_book.getPosition(), Vector());
  EXPECT_EQ(by_the_book.getType(), "Object");
  world.setCompat();
  const Object published;
  EXPECT_EQ(published.getPosition(), Vector(1, 1));
  EXPECT_EQ(published.getType(), "(Undefined)");
  PlacedObject moved(Vector(7, 8));
  EXPECT_EQ(Object(moved).getPosition(), Vector(7, 8));
}

TEST_F(CompatDefaults, WidgetsHaveThePublishedDefaults) {
  EXPECT_EQ(std::make_unique<Pause>()->getType(), "df-pause");
  EXPECT_EQ(std::make_unique<Press>()->getPosition(), Vector(40, 1));
  EXPECT_EQ(std::make_unique<Entry>()->getLimit(), 30);
  EXPECT_EQ(std::make_unique<Entry>()->getBlinkRate(), 15);
  world.setCompat();
  EXPECT_EQ(std::make_unique<Pause>()->getType(), "Pause");
  EXPECT_EQ(std::make_unique<Press>()->getPosition(), Vector(40, 12));
  EXPECT_EQ(std::make_unique<Entry>()->getLimit(), 1);
  EXPECT_EQ(std::make_unique<Entry>()->getBlinkRate(), 10);
  ViewObject left;
  left.setBorder(false);
  left.setLocation(CENTER_LEFT);
  EXPECT_EQ(left.getPosition().y(), 12);
}

TEST_F(CompatDefaults, AViewEventHasNoTag) {
  EXPECT_EQ(EventView().getTag(), VIEW_EVENT);
  world.setCompat();
  EXPECT_EQ(EventView().getTag(), "");
}

TEST_F(CompatDefaults, UnregisteringAnUnknownInterestSucceeds) {
  Probe probe;
  EXPECT_EQ(probe.unregisterInterest(VIEW_EVENT), -1);
  world.setCompat();
  EXPECT_EQ(probe.unregisterInterest(VIEW_EVENT), 0);
  probe.registerInterest(VIEW_EVENT);
  EXPECT_EQ(probe.unregisterInterest(VIEW_EVENT), 0);
  EXPECT_EQ(probe.getEventCount(), 0);
}

TEST_F(CompatDefaults, ACircleInsideABoxDoesNotIntersectIt) {
  const Box box(Vector(0, 0), 10, 10);
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(5, 5), 2), box));
  world.setCompat();
  EXPECT_FALSE(circleIntersectsBox(Circle(Vector(5, 5), 2), box));
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(2, 5), 2), box)) << "it touches the edge from within";
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(1, 5), 2), box));
  EXPECT_TRUE(circleIntersectsBox(Circle(Vector(5, 5), 20), box));
  EXPECT_FALSE(circleIntersectsBox(Circle(Vector(-3, 5), 2), box));
}

// 505 rounded steps of 0.1 end within 2e-9 cells of 50.5, where the box's upper edge touches the boundary. In
// exact numbers the box is then outside, in floats it is not.
TEST_F(CompatDefaults, ABoxThatTouchesTheBoundaryIsStillInside) {
  world.setCompat();
  WM.setBoundary(Box(Vector(), 80, 50));
  Probe probe("probe", &received, Vector(40, 0));
  probe.setBox(Box(Vector(-0.5, -0.5), 1, 1));
  probe.setSolidness(SPECTRAL);
  probe.setPosition(Vector(40, 50.4));
  WM.moveObject(&probe, Vector(40, 50.5 + 2e-9));
  EXPECT_TRUE(received.empty());
  WM.moveObject(&probe, Vector(40, 50.6));
  EXPECT_EQ(received, std::vector<std::string>{"probe:df-out"});
}

// Tests whether the members are zero although the memory has been used before.
__attribute__((noinline)) bool isClear(const Careless& o) {
  const Careless* volatile p_o = &o;
  if (p_o->p_target != nullptr || p_o->lives != 0) return false;
  for (const unsigned char byte : p_o->rest) {
    if (byte != 0) return false;
  }
  return true;
}

TEST_F(CompatDefaults, NewObjectMemoryIsZeroed) {
  world.setCompat();
  constexpr std::align_val_t kLine{64};
  for (int i = 0; i < 20; ++i) {
    void* p = ::operator new(sizeof(Careless), kLine);
    std::memset(p, 0xA5, sizeof(Careless));
    asm volatile("" : : "r"(p) : "memory");
    ::operator delete(p, kLine);
    auto* p_o = new Careless;
    EXPECT_TRUE(isClear(*p_o)) << i;
    auto* p_other = new (std::nothrow) Careless;
    EXPECT_TRUE(isClear(*p_other)) << i;
    delete p_o;
    WM.markForDelete(p_other);
  }
}

}  // namespace
}  // namespace df::test
