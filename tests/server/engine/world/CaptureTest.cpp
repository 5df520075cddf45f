#include <stdexcept>

#include "engine/managers/DisplayManager.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Capture : public WorldTest {
 protected:
  void tickWatched() {
    world.store().setWatched(true);
    GM.tick();
  }
  Probe* make(const std::string& name, double x, double y, int altitude = 2) {
    auto* p = new Probe(name, nullptr, Vector(x, y));
    p->setSolidness(SPECTRAL);
    p->setAltitude(altitude);
    p->on_draw = [this](Probe& self) {
      received.push_back(self.getType());
      DM.drawCh(self.getPosition(), self.getType()[0], RED);
    };
    return p;
  }
  const ObjectFacts* changed(const Object& o) const {
    for (const ObjectFacts& f : world.picture().view().changed) {
      if (f.key == o.key()) return &f;
    }
    return nullptr;
  }
};

TEST_F(Capture, DrawsByAltitudeThenCreation) {
  make("c", 3, 3, 4);
  make("a", 3, 3, 0);
  make("d", 3, 3, 4);
  make("b", 3, 3, 2);
  GM.tick();
  EXPECT_EQ(received, (Received{"a", "b", "c", "d"}));
  EXPECT_EQ(world.picture().render({}).at(3, 3).ch, U'd');
  EXPECT_EQ(world.picture().render({}).at(3, 3).color, RED);
}

TEST_F(Capture, InactiveInvisibleAndDistantObjectsAreNotDrawn) {
  make("a", 3, 3)->setActive(false);
  make("b", 3, 3)->setVisible(false);
  make("c", 100, 3);
  make("d", 80.5, 3);  // its box touches the view
  make("e", 80.75, 3);
  WM.draw();
  EXPECT_EQ(received, (Received{"d"}));
}

TEST_F(Capture, ObjectsInAPlayersViewAreDrawn) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  Probe* a = make("a", 300, 300);
  GM.tick();
  EXPECT_TRUE(received.empty());
  const std::uint32_t ann = joined("ann");
  WM.getPlayer(ann)->setObject(a);
  GM.tick();
  EXPECT_EQ(received, (Received{"a"}));
  EXPECT_EQ(world.picture().renderPlayer(ann).at(40, 12).ch, U'a');
  EXPECT_EQ(world.picture().renderPlayer(0).at(40, 12).ch, U' ');
}

TEST_F(Capture, CellIsTheRoundedPositionMinusTheRoundedCorner) {
  WM.setBoundary(Box(Vector(0, 0), 500, 500));
  make("a", 10.5, 9.49);
  WM.setView(Box(Vector(2.5, 1.25), 80, 24));
  GM.tick();
  EXPECT_EQ(world.picture().renderPlayer(0).at(11 - 3, 9 - 1).ch, U'a');
  EXPECT_EQ(world.picture().render({}).at(11, 9).ch, U'a');
}

TEST_F(Capture, StringsAreJustifiedAndCleaned) {
  Probe* a = make("a", 0, 0);
  a->on_draw = [](Probe&) {
    DM.drawString(Vector(10, 1), "left\n\xC3\xA9", LEFT_JUSTIFIED, CYAN);
    DM.drawString(Vector(10, 2), "middle", CENTER_JUSTIFIED);
    DM.drawString(Vector(10, 3), "right", RIGHT_JUSTIFIED);
    EXPECT_EQ(DM.drawString(Vector(3e9, 3), "far"), -1);
    EXPECT_EQ(DM.drawCh(Vector(0, 3), 'x', UNDEFINED_COLOR), -1);
    DM.drawCh(Vector(0, 4), '\xE9');
    DM.drawCh(Vector(1, 4), char32_t{0x2588});
  };
  GM.tick();
  const Canvas canvas = world.picture().render({});
  EXPECT_EQ(canvas.rowText(1).substr(0, 18), "          left?\xC3\xA9 ");
  EXPECT_EQ(canvas.rowText(2).substr(0, 14), "       middle ");
  EXPECT_EQ(canvas.rowText(3).substr(0, 12), "     right  ");
  EXPECT_EQ(canvas.at(0, 4).ch, U'?');
  EXPECT_EQ(canvas.at(1, 4).ch, char32_t{0x2588});
}

TEST_F(Capture, StaticLookIsDrawnOnceAndMovesAlong) {
  Probe* a = make("a", 3, 3);
  a->setStaticLook();
  a->setVelocity(Vector(1, 0));
  for (int i = 0; i < 3; ++i) GM.tick();
  EXPECT_EQ(received, (Received{"a"}));
  EXPECT_EQ(world.picture().render({}).at(6, 3).ch, U'a');
  ASSERT_EQ(world.picture().view().drawn.size(), 1u);
  EXPECT_EQ(world.picture().view().drawn[0].count, 1u);
  a->setStaticLook();
  GM.tick();
  EXPECT_EQ(received, (Received{"a", "a"}));
  WM.removeObject(a);
  WM.insertObject(a);
  for (int i = 0; i < 2; ++i) GM.tick();
  EXPECT_EQ(received, (Received{"a", "a", "a"})) << "it returned";
}

TEST_F(Capture, CommandsNameTheObjectThatDrewThem) {
  Probe* a = make("a", 3, 3);
  Object plain;  // an Object without a class of its own: draw() is not called
  Probe* silent = make("s", 4, 4);
  silent->on_draw = nullptr;
  a->on_event = [](Probe&, const Event&) { DM.drawCh(Vector(1, 1), '!', RED); };
  world.input().join("ann", RED);
  a->registerInterest("df-join");
  GM.tick();
  const WorldView& view = world.picture().view();
  ASSERT_EQ(view.drawn.size(), 3u);
  EXPECT_EQ(view.drawn[0].key, ObjectKey{});
  EXPECT_EQ(view.drawn[1].key, a->key());
  EXPECT_EQ(view.drawn[1].first, 1u);
  EXPECT_EQ(view.drawn[1].count, 1u);
  EXPECT_EQ(view.drawn[2].key, silent->key());
  EXPECT_EQ(view.drawn[2].count, 0u);
  EXPECT_EQ(view.commands.size(), 2u);
}

TEST_F(Capture, DrawMayDeleteAndThrow) {
  Probe* a = make("a", 3, 3);
  Probe* b = make("b", 4, 3);
  Probe* c = make("c", 5, 3);
  a->on_draw = [&](Probe& self) {
    delete b;
    delete &self;
  };
  c->on_draw = [](Probe&) { throw std::runtime_error("cannot draw"); };
  GM.tick();
  EXPECT_EQ(logged("cannot draw"), 1);
  GM.tick();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(Capture, DrawCannotStartATickOrAnotherDraw) {
  Probe* a = make("a", 3, 3);
  a->on_draw = [this](Probe& self) {
    received.push_back("draw");
    WM.draw();
    GM.tick();
    DM.drawCh(self.getPosition(), 'a');
  };
  WM.draw();
  GM.tick();
  EXPECT_EQ(received, (Received{"draw", "draw"}));
  EXPECT_EQ(GM.getStepCount(), 1);
  EXPECT_EQ(world.picture().view().commands.size(), 1u);
}

TEST_F(Capture, ShutDownInsideDrawWaitsForItsEnd) {
  Probe* a = make("a", 3, 3);
  a->on_draw = [](Probe& self) {
    WM.shutDown();
    DM.drawCh(self.getPosition(), 'a');
  };
  WM.draw();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(Capture, UnwatchedTicksReportNothingFirstWatchedReportsAll) {
  Object a;
  Object b;
  GM.tick();
  EXPECT_TRUE(world.picture().view().changed.empty());
  tickWatched();
  ASSERT_EQ(world.picture().view().changed.size(), 2u);
  EXPECT_EQ(world.picture().view().changed[0].key, a.key());
  EXPECT_EQ(world.picture().view().changed[1].key, b.key());
  EXPECT_EQ(world.picture().view().tick, 2u);
  EXPECT_EQ(world.picture().view().boundary.size.x, fromCells(80));
  GM.tick();
  EXPECT_TRUE(world.picture().view().changed.empty());
}

TEST_F(Capture, ChangesAreReportedInCreationOrder) {
  Object a;
  Object b;
  Object c;
  tickWatched();
  c.setAltitude(3);
  a.setSolidness(SPECTRAL);
  a.setVelocity(Vector(0, 0.5));
  b.setPosition(b.getPosition());  // no change
  GM.tick();
  ASSERT_EQ(world.picture().view().changed.size(), 2u);
  EXPECT_EQ(world.picture().view().changed[0].key, a.key());
  EXPECT_EQ(world.picture().view().changed[0].position.y, kFixedOne / 2);
  EXPECT_EQ(world.picture().view().changed[1].altitude, 3);
  GM.tick();  // a is still moving
  ASSERT_EQ(world.picture().view().changed.size(), 1u);
}

TEST_F(Capture, EveryPropertyChangeIsReported) {
  Object o;
  tickWatched();
  const std::pair<const char*, std::function<void()>> kChanges[] = {
      {"solidness", [&] { o.setSolidness(SOFT); }},
      {"no soft", [&] { o.setNoSoft(); }},
      {"box", [&] { o.setBox(Box(Vector(0, 0), 2, 2)); }},
      {"invisible", [&] { o.setVisible(false); }},
      {"inactive", [&] { o.setVisible(true), o.setActive(false); }},
      {"position", [&] { o.setPosition(Vector(5, 5)); }},
  };
  for (const auto& [name, change] : kChanges) {
    GM.tick();
    EXPECT_EQ(changed(o), nullptr) << "before " << name;
    change();
    GM.tick();
    ASSERT_NE(changed(o), nullptr) << name;
    EXPECT_EQ(changed(o)->shown, o.isVisible() && o.isActive()) << name;
  }
  o.setType("other");
  GM.tick();
  EXPECT_EQ(changed(o), nullptr);
}

TEST_F(Capture, BlockedObjectReportsNoVelocityUntilFree) {
  PlacedObject wall(Vector(12, 10));
  PlacedObject a(Vector(10.5, 10));
  a.setVelocity(Vector(1, 0));
  a.setAcceleration(Vector(0.5, 0));
  tickWatched();
  ASSERT_NE(changed(a), nullptr);
  EXPECT_EQ(changed(a)->velocity, FixedVector{});
  EXPECT_EQ(changed(a)->acceleration, FixedVector{});
  GM.tick();  // still blocked: nothing new, though its velocity grows
  EXPECT_EQ(changed(a), nullptr);
  EXPECT_EQ(a.getVelocity(), Vector(2, 0));
  wall.setSolidness(SPECTRAL);
  GM.tick();
  ASSERT_NE(changed(a), nullptr);
  EXPECT_EQ(toCells(changed(a)->velocity.x), 2.5);
}

TEST_F(Capture, BouncerReportsItsNewVelocity) {
  PlacedObject wall(Vector(12, 10));
  Probe a("a", nullptr, Vector(10.5, 10));
  a.setVelocity(Vector(1, 0));
  a.on_event = [](Probe& self, const Event&) { self.setVelocity(Vector(-1, 0)); };
  tickWatched();
  ASSERT_NE(changed(a), nullptr);
  EXPECT_EQ(toCells(changed(a)->velocity.x), -1);
}

TEST_F(Capture, OnlyReportedObjectsAreReportedVanished) {
  auto* p_a = new Object;
  tickWatched();
  const ObjectKey key = p_a->key();
  p_a->setAltitude(1);
  delete p_a;
  delete new Object;  // created and deleted between two captures
  GM.tick();
  EXPECT_EQ(world.picture().view().vanished, std::vector{key});
  EXPECT_TRUE(world.picture().view().changed.empty());
  GM.tick();
  EXPECT_TRUE(world.picture().view().vanished.empty());
}

TEST_F(Capture, ReinsertedObjectIsReportedAsNew) {
  Object o;
  tickWatched();
  const ObjectKey before = o.key();
  WM.removeObject(&o);
  WM.insertObject(&o);
  GM.tick();
  EXPECT_EQ(world.picture().view().vanished, std::vector{before});
  ASSERT_EQ(world.picture().view().changed.size(), 1u);
  EXPECT_EQ(world.picture().view().changed[0].key, o.key());
  EXPECT_NE(o.key(), before);
}

TEST_F(Capture, SlotReusedWithinATickIsReportedOnce) {
  std::vector<Object*> objects;
  world.store().setWatched(true);
  for (int i = 0; i < 10; ++i) objects.push_back(new Object);
  GM.tick();
  for (Object*& p : objects) {
    p->setAltitude(0);
    delete p;
    p = new Object;
  }
  GM.tick();
  EXPECT_EQ(world.picture().view().changed.size(), 10u);
  EXPECT_EQ(world.picture().view().vanished.size(), 10u);
}

TEST_F(Capture, PlayersAreReportedById) {
  world.store().setWatched(true);
  const std::uint32_t ann = world.input().join("ann", RED);
  world.input().join("bob", BLUE);
  GM.tick();
  auto* p_ship = new Object;
  WM.getPlayer(ann)->setObject(p_ship);
  WM.getPlayer(ann)->setScore(7);
  GM.tick();
  ASSERT_EQ(world.picture().view().players.size(), 2u);
  EXPECT_EQ(world.picture().view().players[0].name, "ann");
  EXPECT_EQ(world.picture().view().players[0].score, 7);
  EXPECT_EQ(world.picture().view().players[0].followed, p_ship->key());
  EXPECT_EQ(world.picture().view().players[1].followed.generation, 0u);
}

}  // namespace
}  // namespace df::test
