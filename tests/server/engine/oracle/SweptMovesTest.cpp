// Tests the oracle's swept moves against sentences of docs/collisions.md.
#include "BookWorld.h"

namespace oracle {
namespace {

class SweptMovesTest : public BookWorld {
 protected:
  Object* makeSwept(double x, double y, Solidness solidness = df::HARD) {
    Object* p_o = make(x, y, solidness);
    p_o->swept = true;
    return p_o;
  }
  /// Makes a window from the top to the bottom of the world.
  Object* makeGlass(double x, Solidness solidness = df::HARD) {
    Object* p_o = make(x, 12, solidness);
    p_o->box = boxOf(1, 24);
    return p_o;
  }

  static constexpr FixedVector kUnit{1, 0};
};

// "An arrow four characters long that flies 15 cells a tick misses the window", but not if it is swept.
TEST_F(SweptMovesTest, SweptArrowStopsJustBeforeTheGlass) {
  for (const bool swept : {false, true}) {
    Object* p_arrow = make(10, swept ? 10 : 20);
    p_arrow->box = boxOf(4, 1);
    p_arrow->velocity = cells(15, 0);
    p_arrow->swept = swept;
    if (!swept) makeGlass(33);
  }
  for (int i = 0; i < 3; ++i) m_world.update();
  EXPECT_EQ(m_world.getAllObjects()[0]->position, cells(55, 20));
  EXPECT_EQ(m_world.getAllObjects()[2]->position, cells(30.5, 10) - kUnit);
  EXPECT_EQ(m_where, cells(30.5, 10) - kUnit);
  EXPECT_EQ(m_events, "2:2>1 1:2>1 2:2>1 1:2>1 ");  // hit in flight, and again from its last position
}

TEST_F(SweptMovesTest, WorldSettingSweepsAllMoves) {
  Object* p_arrow = make(10, 10);
  makeGlass(17);
  m_world.setSweptCollisions(true);
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(25, 10)), -1);
  EXPECT_EQ(p_arrow->position, cells(16, 10) - kUnit);
  m_world.setSweptCollisions(false);
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(25, 10)), 0);
}

// "All solid Objects whose boxes touch the mover's on the path, ordered by time, then creation."
TEST_F(SweptMovesTest, HitsComeInOrderOfTimeThenCreation) {
  Object* p_mover = makeSwept(10, 10);
  make(30, 10, df::SOFT);
  make(20, 10.5, df::SOFT);
  make(20, 9.5, df::SOFT);
  make(25, 12, df::SOFT);  // beside the path
  make(22, 10, df::SPECTRAL);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 10)), 0);
  EXPECT_EQ(p_mover->position, cells(40, 10));
  EXPECT_EQ(m_events, "0:0>2 2:0>2 0:0>3 3:0>3 0:0>1 1:0>1 ");
}

// "It ends with the first time at which a pair would block", but "other Objects hit *at that time* still get
// events".
TEST_F(SweptMovesTest, ObjectsBehindTheBlockerGetNoEvent) {
  Object* p_mover = makeSwept(10, 10);
  make(25, 10, df::SOFT);
  make(20, 10, df::HARD);
  make(20, 9, df::SOFT);
  make(15, 10, df::SOFT);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 10)), -1);
  EXPECT_EQ(m_events, "0:0>4 4:0>4 0:0>2 2:0>2 0:0>3 3:0>3 ");
  EXPECT_EQ(p_mover->position, cells(19, 10) - kUnit);
}

TEST_F(SweptMovesTest, NoSoftMoverStopsBeforeSoft) {
  Object* p_mover = makeSwept(10, 10, df::SOFT);
  p_mover->no_soft = true;
  make(20, 10, df::SOFT);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 10)), -1);
  EXPECT_EQ(p_mover->position, cells(19, 10) - kUnit);
}

// "the last position before that time" applies to both axes, even if only one of them leads to the contact.
TEST_F(SweptMovesTest, BothAxesStopJustBeforeTheContact) {
  Object* p_mover = makeSwept(0, 0);
  make(20, 10);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 20)), -1);
  // The boxes touch in x at 19, in y earlier. One unit before, y is half a unit back, which rounds to one.
  EXPECT_EQ(p_mover->position, cells(19, 9.5) - (FixedVector{1, 1}));
}

// "counts, at time 0, only if the move closes the gap or the boxes also touch at the end".
TEST_F(SweptMovesTest, LeavingAWallIsFreeButSlidingIsBlocked) {
  Object* p_o = makeSwept(10, 10);
  make(11, 10)->box = boxOf(1, 6);
  EXPECT_EQ(m_world.moveObject(p_o, cells(9, 10)), 0);    // away from it
  EXPECT_EQ(m_world.moveObject(p_o, cells(10, 10)), -1);  // back: stopped one unit before
  EXPECT_EQ(p_o->position, cells(10, 10) - kUnit);
  p_o->position = cells(10, 10);
  m_events.clear();
  EXPECT_EQ(m_world.moveObject(p_o, cells(10, 12)), -1);  // along it
  EXPECT_EQ(m_world.moveObject(p_o, cells(14, 10)), -1);  // into it
  EXPECT_EQ(p_o->position, cells(10, 10));
  EXPECT_EQ(m_where, cells(10, 10));
  EXPECT_EQ(m_events, "0:0>1 1:0>1 0:0>1 1:0>1 ");
  EXPECT_EQ(m_world.moveObject(p_o, cells(10, 14)), 0);  // off its end
  EXPECT_EQ(m_events, "0:0>1 1:0>1 0:0>1 1:0>1 ");
}

// "one inside another may leave by the shortest path", in a single move.
TEST_F(SweptMovesTest, ObjectInsideMayLeaveByTheShortestPath) {
  Object* p_o = makeSwept(12, 10);
  make(10, 10)->box = boxOf(6, 6);
  EXPECT_EQ(m_world.moveObject(p_o, cells(13.25, 10)), -1);  // not out yet
  EXPECT_EQ(m_world.moveObject(p_o, cells(5, 10)), -1);      // the long path: deeper at first
  EXPECT_EQ(p_o->position, cells(12, 10));
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), 0);
}

// "If none blocks in the end (the handler broke the glass), the mover continues".
TEST_F(SweptMovesTest, BrokenGlassLetsTheArrowThroughToTheNext) {
  Object* p_arrow = makeSwept(10, 10);
  Object* p_glass = makeGlass(20);
  makeGlass(30, df::SOFT);
  makeGlass(40);
  m_on_collision = [&](Object* p_receiver) {
    if (p_receiver == p_glass) m_world.destroy(p_glass);
  };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 gone:1 0:0>2 2:0>2 0:0>3 3:0>3 ");
  EXPECT_EQ(p_arrow->position, cells(39, 10) - kUnit);
  EXPECT_EQ(m_world.counters().swept_passed_on, 1);
}

// "in the world as it is then, for Objects not yet met in this move".
TEST_F(SweptMovesTest, RemainingPathSeesChangesMadeByHandlers) {
  Object* p_arrow = makeSwept(10, 10);
  Object* p_glass = makeGlass(20);
  Object* p_met = makeGlass(15, df::SOFT);
  Object* p_late = makeGlass(70);
  Object* p_behind = makeGlass(5);
  m_on_collision = [&](Object* p_receiver) {
    if (p_receiver != p_glass) return;
    p_glass->solidness = df::SOFT;  // still there, but already met
    p_met->position = cells(30, 12);
    p_met->solidness = df::HARD;
    p_late->position = cells(40, 12);
    p_behind->position = cells(17, 12);  // behind the mover
  };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(m_events, "0:0>2 2:0>2 0:0>1 1:0>1 0:0>3 3:0>3 ");
  EXPECT_EQ(p_arrow->position, cells(39, 10) - kUnit);
}

// If nothing blocks, there is one search: Objects that enter the path later are not met.
TEST_F(SweptMovesTest, UnblockedMoveSearchesOnce) {
  Object* p_arrow = makeSwept(10, 10);
  makeGlass(20, df::SOFT);
  Object* p_late = makeGlass(70);
  m_on_collision = [&](Object*) { p_late->position = cells(40, 12); };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), 0);
  EXPECT_EQ(p_arrow->position, cells(50, 10));
}

// "Both Objects of each pair get the event, then the pair is judged."
TEST_F(SweptMovesTest, PairHardenedByItsHandlerBlocksTheMove) {
  Object* p_arrow = makeSwept(10, 10);
  Object* p_foam = makeGlass(20, df::SOFT);
  makeGlass(30);
  m_on_collision = [&](Object*) { p_foam->solidness = df::HARD; };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(p_arrow->position, cells(19, 10) - kUnit);
}

// "The mover is placed at the last position before that time, unless a handler moved it".
TEST_F(SweptMovesTest, BlockedMoverStaysWhereAHandlerPutIt) {
  Object* p_arrow = makeSwept(10, 10);
  makeGlass(20);
  m_on_collision = [&](Object*) { p_arrow->position = cells(3, 3); };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(p_arrow->position, cells(3, 3));
}

TEST_F(SweptMovesTest, MoverTurnedSpectralPassesToTheTarget) {
  Object* p_ghost = makeSwept(10, 10);
  makeGlass(20);
  makeGlass(30);
  m_on_collision = [&](Object*) { p_ghost->solidness = df::SPECTRAL; };
  EXPECT_EQ(m_world.moveObject(p_ghost, cells(50, 10)), 0);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(p_ghost->position, cells(50, 10));
}

TEST_F(SweptMovesTest, MoverStoppedOutsideTheWorldGetsAnOutEvent) {
  Object* p_o = makeSwept(70, 10);
  make(90, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(100, 10)), -1);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 out:0 ");
}

// firstContact() moves nothing, sends no events and returns the first hit, whether or not it blocks.
TEST_F(SweptMovesTest, FirstContactHasObjectTimeAndPosition) {
  Object* p_o = make(10, 10);
  makeGlass(40);
  Object* p_foam = makeGlass(21, df::SOFT);
  Contact contact = m_world.firstContact(p_o, cells(30, 10));
  EXPECT_EQ(contact.p_object, p_foam);
  EXPECT_EQ(contact.time.toDouble(), 0.5);
  EXPECT_EQ(contact.position, cells(20, 10) - kUnit);
  contact = m_world.firstContact(p_o, cells(19, 20));
  EXPECT_EQ(contact.p_object, nullptr);
  EXPECT_EQ(contact.time.toDouble(), 1);
  EXPECT_EQ(contact.position, cells(19, 20));
  EXPECT_EQ(m_events, "");
}

}  // namespace
}  // namespace oracle
