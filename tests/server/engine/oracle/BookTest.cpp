// Tests the oracle itself against sentences of the book's section 4.10 and of docs/collisions.md. Other
// sentences are tested with the engine, which the oracle equals.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "Oracle.h"

namespace oracle {
namespace {

FixedVector cells(double x, double y) {
  return {*df::toFixed(x), *df::toFixed(y)};
}

/// Returns a box of this many cells, centred on the position.
FixedBox boxOf(double width, double height) {
  return {cells(-width / 2, -height / 2), cells(width, height)};
}

/// An oracle world that records all received events in one line of text.
class BookTest : public testing::Test, protected Handlers {
 protected:
  Object* make(double x, double y, Solidness solidness = df::HARD) {
    Object* p_o = m_world.create(m_next++);
    p_o->position = cells(x, y);
    p_o->solidness = solidness;
    return p_o;
  }
  Object* makeSwept(double x, double y) {
    Object* p_o = make(x, y);
    p_o->options.swept = true;
    return p_o;
  }
  /// Makes a window from the top to the bottom of the world.
  Object* makeGlass(double x, Solidness solidness = df::HARD) {
    Object* p_o = make(x, 12, solidness);
    p_o->box = boxOf(1, 24);
    return p_o;
  }

  void step(Object*) override {}
  void collision(Object* p_receiver, Object* p_obj1, Object* p_obj2, FixedVector where) override {
    m_events += std::to_string(p_receiver->id) + ":" + std::to_string(p_obj1->id) + ">" +
                std::to_string(p_obj2->id) + " ";
    m_where = where;
    if (m_on_collision) m_on_collision(p_receiver);
  }
  void out(Object* p_receiver) override { m_events += "out:" + std::to_string(p_receiver->id) + " "; }
  void destroyed(Object* p_o) override { m_events += "gone:" + std::to_string(p_o->id) + " "; }

  static constexpr FixedVector kUnit{1, 0};

  World m_world{FixedBox{{}, cells(80, 24)}, *this};
  std::string m_events;  ///< "receiver:mover>other "
  FixedVector m_where;   ///< position of the last collision
  std::function<void(Object*)> m_on_collision;
  int m_next = 0;
};

// "their x coordinates are within 1 space of each other and their y coordinates are within 1 space".
TEST_F(BookTest, CharactersWithinOneSpaceIntersect) {
  Object* p_o = make(10, 10);
  make(11, 11);
  EXPECT_EQ(m_world.getCollisions(p_o, cells(10, 10)).size(), 1U);
  EXPECT_TRUE(m_world.getCollisions(p_o, cells(10, 10) - FixedVector{1, 0}).empty());
  EXPECT_TRUE(m_world.getCollisions(p_o, cells(10, 10) - FixedVector{0, 1}).empty());
  EXPECT_EQ(m_world.getCollisions(p_o, cells(12, 12)).size(), 1U);
}

// "any number of SOFT Objects can occupy a space, with our without at most one HARD Object".
TEST_F(BookTest, SoftObjectsShareASpaceAndAllGetEvents) {
  make(15, 10, df::SOFT);
  make(15, 10, df::HARD);
  Object* p_mover = make(10, 10, df::SOFT);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(15, 10)), 0);
  EXPECT_EQ(p_mover->position, cells(15, 10));
  EXPECT_EQ(m_events, "2:2>0 0:2>0 2:2>1 1:2>1 ");
}

TEST_F(BookTest, HardBlockerDoesNotSuppressOtherCollisionEvents) {
  make(15, 10, df::HARD);
  make(15, 10, df::SOFT);
  Object* p_mover = make(10, 10);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(15, 10)), -1);
  EXPECT_EQ(m_events, "2:2>0 0:2>0 2:2>1 1:2>1 ");
}

// "Two head-on movers produce four" events per tick, one pair for each of the two moves.
TEST_F(BookTest, HeadOnMoversCollideTwice) {
  make(10, 10)->velocity = cells(1, 0);
  make(11.5, 10)->velocity = cells(-1, 0);
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 1:1>0 0:1>0 ");
}

TEST_F(BookTest, BlockingIsDecidedAfterTheHandlers) {
  Object* p_ghost = make(10, 10);
  make(15, 10);
  m_on_collision = [&](Object* p_receiver) {
    if (p_receiver == p_ghost) p_ghost->solidness = df::SPECTRAL;
  };
  EXPECT_EQ(m_world.moveObject(p_ghost, cells(15, 10)), 0);
  EXPECT_EQ(p_ghost->position, cells(15, 10));
}

TEST_F(BookTest, ObjectBornInHandlerCollidesNowMovesNextTick) {
  Object* p_mover = make(10, 10, df::SOFT);
  p_mover->velocity = cells(1, 0);
  make(12, 10, df::SOFT);
  Object* p_second = make(30, 10, df::SOFT);
  p_second->velocity = cells(1, 0);
  Object* p_born = nullptr;
  m_on_collision = [&](Object*) {
    if (p_born != nullptr) return;
    p_born = make(32, 10, df::SOFT);
    p_born->velocity = cells(1, 0);
  };
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 2:2>3 3:2>3 ");
  EXPECT_EQ(p_born->position, cells(32, 10));
  m_world.update();
  EXPECT_EQ(p_born->position, cells(33, 10));
}

TEST_F(BookTest, InactiveObjectsNeitherMoveCollideNorReceiveEvents) {
  Object* p_sleeper = make(15, 10);
  p_sleeper->velocity = cells(1, 0);
  p_sleeper->active = false;
  Object* p_mover = make(10, 10);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(15, 10)), 0);
  m_world.update();
  EXPECT_EQ(p_sleeper->position, cells(15, 10));
  EXPECT_EQ(m_events, "");
}

TEST_F(BookTest, ObjectDeletedByAHandlerBlocksNothing) {
  Object* p_mover = make(10, 10);
  make(15, 10);
  Object* p_wall = make(15, 10);
  m_on_collision = [&](Object*) {
    if (!p_wall->gone) m_world.destroy(p_wall);
  };
  m_world.getAllObjects()[1]->solidness = df::SOFT;
  EXPECT_EQ(m_world.moveObject(p_mover, cells(15, 10)), 0);
  EXPECT_EQ(m_events, "0:0>1 gone:2 1:0>1 ");
}

TEST_F(BookTest, NestedMovesAreLimitedToThirtyTwo) {
  Object* p_o = make(10, 10);
  make(11, 10);
  int refused = 0;
  m_on_collision = [&](Object* p_receiver) {
    if (p_receiver == p_o && refused == 0 && m_world.moveObject(p_o, cells(10, 10)) == -1) ++refused;
  };
  EXPECT_EQ(m_world.moveObject(p_o, cells(10, 10)), -1);
  EXPECT_EQ(m_world.counters().too_deep, 1);
  EXPECT_EQ(m_world.counters().moves, 33);  // plus the refused one
}

// "Two characters side by side touch by their boxes but share no cell".
TEST_F(BookTest, PreciseCharactersPassSideBySide) {
  Object* p_o = make(10, 10);
  make(15, 11);
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), -1);
  p_o->options.precise = true;
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), 0);
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10.5)), -1);  // 10.5 lies in the cell of 11
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10.5) - FixedVector{0, 1}), 0);
}

// "the time is the first at which the masks share a cell and the boxes touch"
TEST_F(BookTest, SweptShotStopsAtTheEndOfAHole) {
  Object* p_mouth = make(20, 10);
  p_mouth->box = boxOf(5, 3);
  p_mouth->mask = {"#####", "    #", "#####"};
  p_mouth->options.precise = true;
  Object* p_shot = make(10, 10);
  p_shot->options.swept = true;
  EXPECT_EQ(m_world.moveObject(p_shot, cells(30, 10)), -1);
  // The throat is in cell 22; the shot enters that cell at 21.5.
  EXPECT_EQ(p_shot->position, cells(21.5, 10) - (FixedVector{1, 0}));
}

// "it may be met later in the move, after the two have separated".
TEST_F(BookTest, ObjectLeavingOneToothMayHitTheNext) {
  Object* p_comb = make(20, 10);
  p_comb->box = boxOf(9, 1);
  p_comb->mask = {"#   #   #"};  // in cells 16, 20 and 24
  p_comb->options.precise = true;
  Object* p_o = make(16, 10);
  p_o->options.swept = true;
  // The box distance is largest above and below, so moving along the comb never closes the gap.
  EXPECT_EQ(m_world.moveObject(p_o, cells(18, 10)), 0);  // between two teeth
  EXPECT_EQ(m_world.moveObject(p_o, cells(16, 10)), -1);
  p_o->position = cells(16, 10);
  m_events.clear();
  EXPECT_EQ(m_world.moveObject(p_o, cells(26, 10)), -1);
  EXPECT_EQ(m_events, "1:1>0 0:1>0 ");
  EXPECT_EQ(p_o->position, cells(19.5, 10) - (FixedVector{1, 0}));
  p_o->position = cells(16, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(24, 10)), -1);  // ends in a tooth: the contact at the start counts
  EXPECT_EQ(p_o->position, cells(16, 10));
}

// An Object with rest contacts collides in every update as if it had moved to its own position.
TEST_F(BookTest, RestContactsAreSentOnRequest) {
  Object* p_floor = make(10, 10);
  make(11, 10);
  m_world.update();
  EXPECT_EQ(m_events, "");
  p_floor->options.rest_contacts = true;
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(m_where, cells(10, 10));
  p_floor->options.swept = true;
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 0:0>1 1:0>1 ");
}

// "A HARD Object placed inside another can then leave it. Both still get events."
TEST_F(BookTest, MoveOutObjectLeavesAWallStepByStep) {
  for (const bool swept : {false, true}) {
    Object* p_o = make(12, swept ? 18 : 6);
    p_o->options.swept = swept;
    make(10, swept ? 18 : 6)->box = boxOf(6, 6);
    const FixedVector start = p_o->position;
    const FixedVector step = cells(0.5, 0);
    EXPECT_EQ(m_world.moveObject(p_o, start + step), -1);
    p_o->options.may_move_out = true;
    EXPECT_EQ(m_world.moveObject(p_o, start - step), -1);  // deeper
    EXPECT_EQ(m_world.moveObject(p_o, start), -1);         // as deep as before
    m_events.clear();
    EXPECT_EQ(m_world.moveObject(p_o, start + step), 0);
    EXPECT_EQ(m_events, swept ? "2:2>3 3:2>3 " : "0:0>1 1:0>1 ");
    EXPECT_EQ(p_o->position, start + step);
    EXPECT_EQ(m_world.counters().moved_out, swept ? 2 : 1);
  }
}

// "a pair that touches at the start of the move": other pairs block as always.
TEST_F(BookTest, MovingOutDoesNotAllowEnteringAnother) {
  Object* p_o = make(10, 10);
  p_o->options.may_move_out = true;
  make(9.5, 10);
  make(12, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(11, 10)), -1);
  EXPECT_EQ(m_world.moveObject(p_o, cells(10.5, 10)), 0);
}

// "the position nearest to `near`, in whole cells from it"; of equally near positions, the one with the least
// y, then the least x.
TEST_F(BookTest, FindFreeReturnsTheNearestPosition) {
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(10.5, 10.5));
  make(10.5, 10.5);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(10.5, 8.5));  // one cell away touches
  make(10.5, 8.5);
  EXPECT_EQ(m_world.findFree(kCharacterBox, cells(10.5, 10.5)), cells(8.5, 10.5));
}

// "An arrow four characters long that flies 15 cells a tick misses the window", but not if it is swept.
TEST_F(BookTest, SweptArrowStopsJustBeforeTheGlass) {
  for (const bool swept : {false, true}) {
    Object* p_arrow = make(10, swept ? 10 : 20);
    p_arrow->box = boxOf(4, 1);
    p_arrow->velocity = cells(15, 0);
    p_arrow->options.swept = swept;
    if (!swept) makeGlass(33);
  }
  for (int i = 0; i < 3; ++i) m_world.update();
  EXPECT_EQ(m_world.getAllObjects()[0]->position, cells(55, 20));
  EXPECT_EQ(m_world.getAllObjects()[2]->position, cells(30.5, 10) - kUnit);
  EXPECT_EQ(m_where, cells(30.5, 10) - kUnit);
  EXPECT_EQ(m_events, "2:2>1 1:2>1 2:2>1 1:2>1 ");  // hit in flight, and again from its last position
}

TEST_F(BookTest, WorldSettingSweepsAllMoves) {
  Object* p_arrow = make(10, 10);
  makeGlass(17);
  m_world.setSweptCollisions(true);
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(25, 10)), -1);
  EXPECT_EQ(p_arrow->position, cells(16, 10) - kUnit);
  m_world.setSweptCollisions(false);
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(25, 10)), 0);
}

// "All solid Objects whose boxes touch the mover's on the path, ordered by time, then creation."
TEST_F(BookTest, HitsComeInOrderOfTimeThenCreation) {
  Object* p_mover = makeSwept(10, 10);
  make(30, 10, df::SOFT);
  make(20, 10.5, df::SOFT);
  make(20, 9.5, df::SOFT);
  make(25, 12, df::SOFT);  // next to the path
  make(22, 10, df::SPECTRAL);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 10)), 0);
  EXPECT_EQ(p_mover->position, cells(40, 10));
  EXPECT_EQ(m_events, "0:0>2 2:0>2 0:0>3 3:0>3 0:0>1 1:0>1 ");
}

// "It ends with the first time at which a pair would block", but "other Objects hit *at that time* still get
// events".
TEST_F(BookTest, ObjectsBehindTheBlockerGetNoEvent) {
  Object* p_mover = makeSwept(10, 10);
  make(25, 10, df::SOFT);
  make(20, 10, df::HARD);
  make(20, 9, df::SOFT);
  make(15, 10, df::SOFT);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 10)), -1);
  EXPECT_EQ(m_events, "0:0>4 4:0>4 0:0>2 2:0>2 0:0>3 3:0>3 ");
  EXPECT_EQ(p_mover->position, cells(19, 10) - kUnit);
}

// "the last position before that time" applies to both axes, even if only one of them leads to the contact.
TEST_F(BookTest, BothAxesStopJustBeforeTheContact) {
  Object* p_mover = makeSwept(0, 0);
  make(20, 10);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(40, 20)), -1);
  // The boxes touch in x at 19, in y earlier. One unit before, y is half a unit back, which rounds to one.
  EXPECT_EQ(p_mover->position, cells(19, 9.5) - (FixedVector{1, 1}));
}

// "counts, at time 0, only if the move closes the gap or the boxes also touch at the end".
TEST_F(BookTest, LeavingAWallIsFreeButSlidingIsBlocked) {
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
TEST_F(BookTest, ObjectInsideMayLeaveByTheShortestPath) {
  Object* p_o = makeSwept(12, 10);
  make(10, 10)->box = boxOf(6, 6);
  EXPECT_EQ(m_world.moveObject(p_o, cells(13.25, 10)), -1);  // not out yet
  EXPECT_EQ(m_world.moveObject(p_o, cells(5, 10)), -1);      // the long path: deeper at first
  EXPECT_EQ(p_o->position, cells(12, 10));
  EXPECT_EQ(m_world.moveObject(p_o, cells(15, 10)), 0);
}

// "If none blocks in the end (the handler broke the glass), the mover continues".
TEST_F(BookTest, BrokenGlassLetsTheArrowThroughToTheNext) {
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
TEST_F(BookTest, RemainingPathSeesChangesMadeByHandlers) {
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
TEST_F(BookTest, UnblockedMoveSearchesOnce) {
  Object* p_arrow = makeSwept(10, 10);
  makeGlass(20, df::SOFT);
  Object* p_late = makeGlass(70);
  m_on_collision = [&](Object*) { p_late->position = cells(40, 12); };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), 0);
  EXPECT_EQ(p_arrow->position, cells(50, 10));
}

// "Both Objects of each pair get the event, then the pair is judged."
TEST_F(BookTest, PairHardenedByItsHandlerBlocksTheMove) {
  Object* p_arrow = makeSwept(10, 10);
  Object* p_foam = makeGlass(20, df::SOFT);
  makeGlass(30);
  m_on_collision = [&](Object*) { p_foam->solidness = df::HARD; };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(p_arrow->position, cells(19, 10) - kUnit);
}

// "The mover is placed at the last position before that time, unless a handler moved it".
TEST_F(BookTest, BlockedMoverStaysWhereAHandlerPutIt) {
  Object* p_arrow = makeSwept(10, 10);
  makeGlass(20);
  m_on_collision = [&](Object*) { p_arrow->position = cells(3, 3); };
  EXPECT_EQ(m_world.moveObject(p_arrow, cells(50, 10)), -1);
  EXPECT_EQ(p_arrow->position, cells(3, 3));
}

TEST_F(BookTest, MoverTurnedSpectralPassesToTheTarget) {
  Object* p_ghost = makeSwept(10, 10);
  makeGlass(20);
  makeGlass(30);
  m_on_collision = [&](Object*) { p_ghost->solidness = df::SPECTRAL; };
  EXPECT_EQ(m_world.moveObject(p_ghost, cells(50, 10)), 0);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(p_ghost->position, cells(50, 10));
}

TEST_F(BookTest, MoverStoppedOutsideTheWorldGetsAnOutEvent) {
  Object* p_o = makeSwept(70, 10);
  make(90, 10);
  EXPECT_EQ(m_world.moveObject(p_o, cells(100, 10)), -1);
  EXPECT_EQ(m_events, "0:0>1 1:0>1 out:0 ");
}

// firstContact() moves nothing, sends no events and returns the first hit, whether or not it blocks.
TEST_F(BookTest, FirstContactHasObjectTimeAndPosition) {
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
