// Objects with frames: what is drawn, and what the host receives.
#include "engine/managers/DisplayManager.h"
#include "engine/world/ObjectLookAccess.h"
#include "shared/replica/Look.h"
#include "tests/server/engine/Probe.h"

namespace df {
namespace {

using naiad::Appearance;
using naiad::Selector;
using naiad::Sequence;

Sequence letters() {
  std::vector<Appearance> frames;
  for (const char32_t ch : {U'a', U'b', U'c'})
    frames.push_back({{-256, 0, U'<', CYAN}, {0, 0, ch, CYAN}, {256, 0, U'>', CYAN}});
  return Sequence(frames);
}

class Adorned : public Object {
 public:
  int draw() override { return Object::draw() == 0 ? DM.drawCh(getPosition(), U'*', RED) : -1; }
};

class FramesTest : public test::WorldTest {
 protected:
  std::string row() { return world.picture().render({}).rowText(5).substr(9, 3); }
};

TEST_F(FramesTest, ClockSelectorAdvancesTheFrames) {
  Object object;  // needs no draw() of its own
  object.setPosition(Vector(10, 5));
  ASSERT_EQ(ObjectLookAccess::setFrames(object, letters(), Selector::clock(1, 2)), 0);
  std::string seen;
  for (int i = 0; i < 8; ++i) {
    world.tick();
    seen += row() + " ";
    EXPECT_EQ(row()[1], "abc"[object.getFrame()]);
  }
  EXPECT_EQ(seen, "<a> <a> <b> <b> <c> <c> <a> <a> ");
  EXPECT_EQ(object.getFrameCount(), 3);
}

TEST_F(FramesTest, WatchingHostGetsFramesAndSelector) {
  test::PlacedObject object(Vector(10, 5));
  ObjectLookAccess::setFrames(object, letters(), Selector::turning(1, 5, 7));
  world.tick();
  EXPECT_TRUE(world.picture().view().looks.empty()) << "not watched";
  world.store().setWatched(true);
  Object plain;
  world.tick();
  ASSERT_EQ(world.picture().view().looks.size(), 1u);
  const PublishedLook& look = world.picture().view().looks[0];
  EXPECT_EQ(world.picture().view().drawn[look.drawn].key, object.key());
  EXPECT_EQ(look.p_look->sequence, letters());
  EXPECT_EQ(look.p_look->selector, Selector::turning(1, 5, 7));
}

TEST_F(FramesTest, DrawOfAnObjectMayAddToItsFrames) {
  Adorned object;
  object.setPosition(Vector(10, 5));
  ObjectLookAccess::setFrames(object, letters(), Selector::fixed(1));
  world.tick();
  EXPECT_EQ(row(), "<*>");
}

TEST_F(FramesTest, FramesAreHiddenAndDeletedWithTheObject) {
  auto* p_object = new test::PlacedObject(Vector(10, 5));
  ObjectLookAccess::setFrames(*p_object, letters(), Selector::fixed(2));
  world.tick();
  EXPECT_EQ(row(), "<c>");
  ObjectLookAccess::setSelector(*p_object, Selector::fixed(0));
  world.tick();
  EXPECT_EQ(row(), "<a>");
  p_object->setVisible(false);
  world.tick();
  EXPECT_EQ(row(), "   ");
  p_object->setVisible();
  ObjectLookAccess::setFrames(*p_object, {}, {});
  world.tick();
  EXPECT_EQ(row(), "   ");
  EXPECT_EQ(p_object->getFrameCount(), 0);
  ObjectLookAccess::setFrames(*p_object, letters(), Selector::fixed(2));
  delete p_object;
  for (int i = 0; i < 200; ++i) {  // its slot is reused in this loop
    test::PlacedObject next(Vector(10, 5));
    world.tick();
    ASSERT_EQ(row(), "   ");
  }
}

TEST_F(FramesTest, InvalidFramesAndSelectorsAreRefused) {
  Object object;
  EXPECT_EQ(ObjectLookAccess::setSelector(object, Selector::fixed(0)), -1) << "no frames";
  EXPECT_EQ(ObjectLookAccess::setFrames(object, letters(), Selector::fixed(3)), -1);
  EXPECT_EQ(ObjectLookAccess::setFrames(object, letters(), Selector::clock(0, 0)), -1);
  EXPECT_EQ(ObjectLookAccess::setFrames(object, Sequence(std::vector<Appearance>(257)), {}), -1);
  EXPECT_EQ(ObjectLookAccess::setFrames(object, {Appearance(9000, naiad::Glyph{})}, {}), -1);
  EXPECT_EQ(object.getFrameCount(), 0);
  EXPECT_EQ(ObjectLookAccess::setFrames(object, letters(), Selector::fixed(2)), 0);
  EXPECT_EQ(ObjectLookAccess::setSelector(object, Selector::fixed(3)), -1);
  EXPECT_EQ(object.getFrame(), 2);
  EXPECT_EQ(world.log().refusals(), 6u);
}

}  // namespace
}  // namespace df
