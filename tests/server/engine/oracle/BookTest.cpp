// Tests the oracle itself against sentences of the book's section 4.10.
#include "BookWorld.h"

namespace oracle {
namespace {

using BookTest = BookWorld;

// "the game programmer can just set the speed and direction" - 0.25 spaces to the left every step.
TEST_F(BookTest, UpdateAddsVelocityToPosition) {
  Object* p_saucer = make(40, 12);
  p_saucer->velocity = cells(-0.25, 0);
  for (int i = 0; i < 4; ++i) m_world.update();
  EXPECT_EQ(p_saucer->position, cells(39, 12));
}

// x = 10, 10, 10.1, 10.3 for an acceleration of 0.1: each move uses the old velocity.
TEST_F(BookTest, PositionMovesBeforeVelocityGrows) {
  Object* p_o = make(10, 5);
  const Fixed tenth = *df::toFixed(0.1);
  p_o->acceleration = {tenth, 0};
  m_world.update();
  EXPECT_EQ(p_o->position, cells(10, 5));
  m_world.update();
  EXPECT_EQ(p_o->position.x, df::fromCells(10) + tenth);
  m_world.update();
  EXPECT_EQ(p_o->position.x, df::fromCells(10) + 3 * tenth);
}

// "their x coordinates are within 1 space of each other and their y coordinates are within 1 space".
TEST_F(BookTest, CharactersWithinOneSpaceIntersect) {
  Object* p_o = make(10, 10);
  make(11, 11);
  EXPECT_EQ(m_world.getCollisions(p_o, cells(10, 10)).size(), 1U);
  EXPECT_TRUE(m_world.getCollisions(p_o, cells(10, 10) - FixedVector{1, 0}).empty());
  EXPECT_TRUE(m_world.getCollisions(p_o, cells(10, 10) - FixedVector{0, 1}).empty());
  EXPECT_EQ(m_world.getCollisions(p_o, cells(12, 12)).size(), 1U);
}

// "the first object is moved back to its original location - the collision still happens".
TEST_F(BookTest, HardOntoHardSendsTwoEventsAndBlocks) {
  Object* p_mover = make(10, 10);
  make(15, 10);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(14.5, 10)), -1);
  EXPECT_EQ(p_mover->position, cells(10, 10));
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
  EXPECT_EQ(m_where, cells(14.5, 10));
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

// "Objects that are SPECTRAL cannot collide", whether the mover or the other is SPECTRAL.
TEST_F(BookTest, SpectralObjectsNeverCollide) {
  Object* p_star = make(10, 10, df::SPECTRAL);
  Object* p_hero = make(15, 10);
  EXPECT_EQ(m_world.moveObject(p_star, cells(15, 10)), 0);
  EXPECT_EQ(m_world.moveObject(p_hero, cells(15.5, 10)), 0);
  EXPECT_EQ(m_events, "");
}

// "soft game objects are treated as hard game objects in this case", but "will still generate collisions".
TEST_F(BookTest, NoSoftMoverIsBlockedBySoft) {
  Object* p_mover = make(10, 10, df::SOFT);
  p_mover->no_soft = true;
  make(15, 10, df::SOFT);
  EXPECT_EQ(m_world.moveObject(p_mover, cells(15, 10)), -1);
  EXPECT_EQ(p_mover->position, cells(10, 10));
  EXPECT_EQ(m_events, "0:0>1 1:0>1 ");
}

// An arrow that moves 15 spaces per step passes through the window.
TEST_F(BookTest, OverlapTestingLetsFastObjectsThrough) {
  Object* p_arrow = make(10, 10);
  p_arrow->velocity = cells(15, 0);
  make(17, 10);
  m_world.update();
  EXPECT_EQ(p_arrow->position, cells(25, 10));
  EXPECT_EQ(m_events, "");
}

// "only sends an EventOut once, when the Object first moves from inside to outside the game world".
TEST_F(BookTest, OutEventIsSentOncePerExit) {
  Object* p_o = make(78.5, 10);
  p_o->velocity = cells(1, 0);
  m_world.update();
  EXPECT_EQ(m_events, "");  // at 79.5, still inside
  m_world.update();
  EXPECT_EQ(m_events, "out:0 ");
  m_world.update();
  EXPECT_EQ(m_events, "out:0 ");
  p_o->velocity = cells(-2, 0);
  m_world.update();
  p_o->velocity = cells(1, 0);
  m_world.update();
  EXPECT_EQ(m_events, "out:0 out:0 ");
}

TEST_F(BookTest, LowerBoundaryEdgeIsInsideUpperIsOutside) {
  Object* p_o = make(1, 1);
  m_world.moveObject(p_o, cells(0, 0));
  EXPECT_EQ(m_events, "");
  m_world.moveObject(p_o, cells(0, 0) - FixedVector{1, 0});
  EXPECT_EQ(m_events, "out:0 ");
  m_world.moveObject(p_o, cells(0, 0));
  m_world.moveObject(p_o, cells(0, 24));
  EXPECT_EQ(m_events, "out:0 out:0 ");
}

// "Two head-on movers produce four" events per tick, one pair for each of the two moves.
TEST_F(BookTest, HeadOnMoversCollideTwice) {
  make(10, 10)->velocity = cells(1, 0);
  make(11.5, 10)->velocity = cells(-1, 0);
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 1:1>0 0:1>0 ");
}

TEST_F(BookTest, MarkedObjectsAreDeletedOnceAfterUpdate) {
  Object* p_bullet = make(10, 10);
  p_bullet->velocity = cells(1, 0);
  make(12, 10);
  m_on_collision = [&](Object*) { m_world.markForDelete(p_bullet); };
  m_world.update();
  EXPECT_EQ(m_events, "0:0>1 1:0>1 gone:0 ");
  EXPECT_EQ(m_world.getAllObjects().size(), 1U);
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

}  // namespace
}  // namespace oracle
