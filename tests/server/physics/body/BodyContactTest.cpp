// Contact events of bodies, and the functions that handlers may call.
#include <set>

#include "engine/events/EventOut.h"
#include "engine/world/Capture.h"
#include "engine/world/WorldStore.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class BodyContacts : public BodyScene {};

TEST_F(BodyContacts, BothGetOneEventWithTheImpulse) {
  auto* p_a = ball<Listener>(Vector(0, 0), Vector(6, 0));
  auto* p_b = ball<Listener>(Vector(2, 0), Vector(0, 0));
  p_b->setContactEnds();
  ticks(20);
  ASSERT_EQ(p_a->notes.size(), 1u);
  EXPECT_EQ(p_a->notes[0].p_first, p_a);
  EXPECT_EQ(p_a->notes[0].p_second, p_b);
  EXPECT_NEAR(p_a->notes[0].impulse, 6.0 / 30, 1e-12);
  ASSERT_EQ(p_b->notes.size(), 2u);
  EXPECT_TRUE(p_b->notes[0].is_begin);
  EXPECT_FALSE(p_b->notes[1].is_begin);
}

TEST_F(BodyContacts, RestingBodySendsNoEventsOrUpdates) {
  layFloor();
  auto* p_crate = crate<Listener>(Vector(0, -0.75));
  p_crate->setContactEnds();
  ticks(60);
  ASSERT_EQ(p_crate->notes.size(), 1u);
  EXPECT_NEAR(p_crate->getPosition().y(), -0.5, 1e-9);
  EXPECT_EQ(static_cast<Object*>(p_crate)->getAcceleration(), Vector());
  world.store().setWatched(true);
  world.tick();
  for (int i = 0; i < 30; ++i) {
    world.tick();
    EXPECT_TRUE(world.picture().view().changed.empty());
  }
}

TEST_F(BodyContacts, DeletedFloorLetsBodiesFall) {
  Object* p_floor = layFloor(5, 1);
  Body* p_crate = crate(Vector(0, -0.5));
  Body* p_upper = crate(Vector(0, -1.5));
  ticks(10);
  EXPECT_EQ(p_crate->getPosition().y(), -0.5);
  delete p_floor;
  ticks(30);
  EXPECT_NEAR(p_crate->getPosition().y(), 4.5, 1e-9);
  EXPECT_NEAR(p_upper->getPosition().y(), 3.5, 1e-9);
}

TEST_F(BodyContacts, SoftBodiesGetEventsAndPushNothing) {
  auto* p_soft = ball<Listener>(Vector(3, 0), Vector(0, 0));
  p_soft->setSolidness(SOFT);
  p_soft->setContactEnds();
  auto* p_ball = ball<Listener>(Vector(0, 0), Vector(6, 0));
  Object* p_mist = wall(Vector(6, 0), Vector(0.5, 5));
  p_mist->setSolidness(SOFT);
  ticks(60);
  EXPECT_NEAR(p_ball->getPosition().x(), 12, 1e-9);
  EXPECT_EQ(p_soft->getPosition(), Vector(3, 0));
  ASSERT_EQ(p_soft->notes.size(), 2u);
  EXPECT_EQ(p_soft->notes[0].impulse, 0);
  EXPECT_FALSE(p_soft->notes[1].is_begin);
  ASSERT_EQ(p_ball->notes.size(), 2u);
  EXPECT_EQ(p_ball->notes[1].p_second, p_mist);
}

TEST_F(BodyContacts, FastBodyGetsEventForPassedSoftObject) {
  auto* p_ball = ball<Listener>(Vector(0, 0), Vector(3000, 0));
  wall(Vector(30, 0), Vector(0.1, 5))->setSolidness(SOFT);
  ticks(2);
  EXPECT_EQ(p_ball->notes.size(), 1u);
}

TEST_F(BodyContacts, SpectralBodiesTouchNothing) {
  auto* p_ghost = ball<Listener>(Vector(0, 0), Vector(6, 0));
  p_ghost->setSolidness(SPECTRAL);
  wall(Vector(3, 0), Vector(0.5, 5));
  auto* p_ball = ball<Listener>(Vector(1.5, 0), Vector(0, 0));
  ticks(60);
  EXPECT_NEAR(p_ghost->getPosition().x(), 12, 1e-9);
  EXPECT_TRUE(p_ghost->notes.empty());
  EXPECT_TRUE(p_ball->notes.empty());
}

TEST_F(BodyContacts, HandlerMayDeleteBothBodies) {
  auto* p_bomb = ball<Touchy<Body>>(Vector(0, 0), Vector(6, 0));
  p_bomb->on_contact = [p_bomb](Object* p_other) {
    delete p_other;
    delete p_bomb;
  };
  ball(Vector(2, 0), Vector(0, 0));
  auto* p_third = ball<Listener>(Vector(3, 0), Vector(0, 0));  // it gets the impulse that the first two have
  ticks(20);
  EXPECT_EQ(PM.getBodyCount(), 1);
  EXPECT_NEAR(speedOf(p_third).x(), 6, 1e-9);
}

TEST_F(BodyContacts, HandlerMayCreateBodiesThatReuseRows) {
  wall(Vector(3, 0), Vector(0.5, 20));
  auto* p_splitter = ball<Touchy<Body>>(Vector(0, 0), Vector(6, 0));
  p_splitter->on_contact = [p_splitter](Object* /*p_other*/) {
    for (int i = 0; i < 4; ++i) ball(p_splitter->getPosition() + Vector(-1, 0.5 * i), Vector(-3, 0), 0.1);
    WM.markForDelete(p_splitter);
  };
  ticks(15);
  EXPECT_EQ(PM.getBodyCount(), 4);
  ticks(15);
  EXPECT_EQ(PM.getBodyCount(), 4);
}

TEST_F(BodyContacts, HandlerMaySetTheBodysVelocity) {
  wall(Vector(3, 0), Vector(0.5, 20));
  auto* p_shy = ball<Touchy<Body>>(Vector(0, 0), Vector(6, 0));
  p_shy->on_contact = [p_shy](Object* /*p_other*/) { p_shy->setVelocity(perSecond(Vector(-1, 0))); };
  ticks(60);
  EXPECT_NEAR(speedOf(p_shy).x(), -1, 1e-12);
}

TEST_F(BodyContacts, ChangedBoxBecomesTheShape) {
  layFloor();
  auto* p_body = new Body;  // it has the box of one character, which is one by one here
  p_body->setPosition(Vector(0, -3));
  ticks(60);
  EXPECT_NEAR(p_body->getPosition().y(), -0.5, 1e-9);
  p_body->setBox(Box(Vector(-0.5, -0.25), 1, 0.5));
  ticks(60);
  EXPECT_NEAR(p_body->getPosition().y(), -0.25, 1e-9);
}

TEST_F(BodyContacts, DragAndSpringsActDuringContact) {
  layFloor();
  Body* p_drop = crate(Vector(0, -0.5));
  p_drop->setDrag(0.05);
  p_drop->setFriction(0);
  p_drop->setVelocity(perSecond(Vector(6, 0)));
  ticks(30);
  EXPECT_EQ(p_drop->getPosition().y(), -0.5);
  EXPECT_NEAR(speedOf(p_drop).x(), 6 * std::exp(-1.5), 1e-9);
  Body* p_held = crate(Vector(20, -0.5));  // it is pulled into the floor
  p_held->setSpring(Vector(20, 3), 0.5, 0.1);
  ticks(60);
  EXPECT_NEAR(p_held->getPosition().y(), -0.5, 1e-9);
}

TEST_F(BodyContacts, AspectRatioAppliesToCollisions) {
  OwnWorld there(2);
  wall(Vector(0, 11), Vector(10, 1));
  auto* p_ball = new Body;
  p_ball->setCircle(2);  // the radius is two cell widths, so that it is one cell high on each side
  p_ball->setPosition(Vector(0, 5));
  p_ball->setVelocity(Vector(0, 0.5));
  for (int i = 0; i < 20; ++i) there.world.update();
  EXPECT_NEAR(p_ball->getPosition().y(), 9, 1e-9);
}

TEST_F(BodyContacts, WorldBoundarySendsAnEventButDoesNotBlock) {
  class Leaver : public Listener {
   public:
    int eventHandler(const Event* p_e) override {
      if (p_e->getType() == OUT_EVENT) ++out;
      if (out > 0 && is_deleted) WM.markForDelete(this);
      return Listener::eventHandler(p_e);
    }
    int out = 0;
    bool is_deleted = false;  // by its handler
  };
  auto* p_ball = ball<Leaver>(Vector(78, 5), Vector(30, 0));
  auto* p_deleted = ball<Leaver>(Vector(78.5, 15), Vector(30, 0));
  p_deleted->is_deleted = true;
  const ObjectKey key = p_deleted->key();
  ticks(1);
  EXPECT_NE(world.store().find(key), nullptr);
  ticks(1);
  EXPECT_EQ(world.store().find(key), nullptr);
  ticks(3);
  EXPECT_EQ(PM.getBodyCount(), 1);
  EXPECT_EQ(p_ball->out, 1);
  EXPECT_TRUE(p_ball->notes.empty());
  EXPECT_NEAR(p_ball->getPosition().x(), 83, 1e-9);
}

TEST_F(BodyContacts, ZoneHearsTheEndOfDeletedBodies) {
  for (const Solidness solidness : {SOFT, HARD}) {
    auto* p_zone = crate<Listener>(Vector(0, 0), Vector(3, 3));
    p_zone->setSolidness(SOFT);
    p_zone->setKinematic();
    p_zone->setContactEnds();
    Body* const bodies[] = {crate(Vector(-2, 0)), crate(Vector(0, 0)), crate(Vector(2, 0))};
    for (Body* p_body : bodies) p_body->setSolidness(solidness);
    ticks(2);
    EXPECT_EQ(p_zone->begins(), 3);
    WM.markForDelete(bodies[0]);
    ticks(1);
    ASSERT_EQ(p_zone->ends(), 1);
    EXPECT_EQ(p_zone->notes.back().p_second, bodies[0]);  // it existed during the event
    delete bodies[1];
    ticks(1);
    ASSERT_EQ(p_zone->ends(), 2);
    EXPECT_EQ(p_zone->notes.back().p_second, nullptr);
    bodies[2]->setSolidness(SPECTRAL);
    ticks(3);
    EXPECT_EQ(p_zone->ends(), 3);
    EXPECT_EQ(p_zone->begins(), 3);
    delete p_zone;
    delete bodies[2];
  }
}

// The Objects of a random scene by number. A number is never used again.
struct Crowd {
  static constexpr int kFloor = -1;
  std::map<const Object*, int> numbers;
  std::map<int, Object*> living;
  std::map<int, Object*> inactive;
  std::uint32_t seed = 1;
  int next = 0, ends = 0;

  double part() { return ((seed = seed * 1664525 + 1013904223) >> 8) / 16777216.0; }
  bool is_over = false;  // nothing is changed any more
  int below(int n) { return static_cast<int>(n * part()); }
  Vector place() {
    const double x = 10 * part() - 5;
    return Vector(x, -6 * part());
  }
  Vector velocity() {
    const double x = part() - 0.5;
    return Vector(x, part() - 0.5);
  }
  void enter(Object* p_object) { living[numbers[p_object] = next++] = p_object; }
  int numberOf(const Object* p_object) const {
    const auto at = numbers.find(p_object);
    return at != numbers.end() ? at->second : kFloor;
  }
  void leave(Object* p_object) {
    inactive.erase(numbers[p_object]);
    living.erase(numbers[p_object]);
    numbers.erase(p_object);
  }
  Object* any() {
    auto at = living.begin();
    std::advance(at, below(static_cast<int>(living.size())));
    return at->second;
  }
  void change(Object* p_object);
};

template <class Base>
class InCrowd : public Base {
 public:
  explicit InCrowd(Crowd& its) : crowd(its) { crowd.enter(this); }
  ~InCrowd() override { crowd.leave(this); }

  Crowd& crowd;
};

// Checks that each contact has one begin and one end.
class Guest : public InCrowd<Body> {
 public:
  using InCrowd<Body>::InCrowd;
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      Object* p_other = p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1();
      EXPECT_TRUE(open.insert(crowd.numberOf(p_other)).second) << "a second begin";
      const bool is_floor = crowd.numberOf(p_other) == Crowd::kFloor;
      if (crowd.below(8) == 0) crowd.change(crowd.below(2) == 0 && !is_floor ? p_other : this);
    } else if (p_e->getType() == CONTACT_END_EVENT) {
      const auto* p_c = static_cast<const EventContactEnd*>(p_e);
      Object* p_other = p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1();
      const auto gone = std::find_if(open.begin(), open.end(), [&](int number) {
        return number != Crowd::kFloor && crowd.living.count(number) == 0;
      });
      if (p_other == nullptr) {
        EXPECT_NE(gone, open.end()) << "an end without a begin";
        if (gone != open.end()) open.erase(gone);
      } else {
        EXPECT_EQ(open.erase(crowd.numberOf(p_other)), 1u) << "an end without a begin";
      }
      ++crowd.ends;
      if (crowd.below(8) == 0) crowd.change(this);
    }
    return 1;
  }

  std::set<int> open;
};

void Crowd::change(Object* p_object) {
  if (is_over) return;
  auto* p_body = dynamic_cast<Body*>(p_object);
  constexpr Solidness kAll[] = {HARD, SOFT, SPECTRAL};
  switch (below(p_body != nullptr ? 9 : 5)) {
    case 0:
      delete p_object;
      break;
    case 1:
      WM.markForDelete(p_object);
      break;
    case 2:
      p_object->setPosition(place());
      break;
    case 3:
    case 4:
      p_object->setSolidness(kAll[below(3)]);
      break;
    case 5:
      p_body->setKinematic(!p_body->isKinematic());
      break;
    case 6:
      p_body->setTurning(!p_body->isTurning());
      break;
    case 7:
      p_body->setCircle(0.3 + 0.5 * part());
      break;
    default:
      p_body->setBoxShape(0.5 + part(), 0.5 + part());
  }
}

// Bodies and Objects are deleted and changed at random, by the game and by handlers.
TEST_F(BodyContacts, EveryBeginHasOneEnd) {
  for (int round = 0; round < 16; ++round) {
    OwnWorld own(1, Vector(0, 0.01), round % 2 == 1 ? ACCURACY_FAST : ACCURACY_DEFAULT);
    Crowd crowd;
    crowd.seed = static_cast<std::uint32_t>(round + 1);
    wall(Vector(0, 5), Vector(50, 5));
    for (int tick = 0; tick < 200; ++tick) {
      while (crowd.living.size() < 14) {
        Object* p_new = nullptr;
        if (crowd.below(4) == 0) {
          p_new = new InCrowd<Object>(crowd);
        } else {
          auto* p_guest = new Guest(crowd);
          p_new = p_guest;
          p_guest->setContactEnds();
          if (crowd.below(2) == 0) p_guest->setTurning();
          if (crowd.below(3) == 0) p_guest->setCircle(0.5);
          if (crowd.below(4) == 0) p_guest->setRestitution(0.8);
          p_guest->setVelocity(crowd.velocity());
        }
        p_new->setPosition(crowd.place());
        if (crowd.below(4) == 0) p_new->setSolidness(SOFT);
      }
      for (int i = crowd.below(3); i > 0; --i) crowd.change(crowd.any());
      if (tick % 10 == 0) {  // an inactive Object gets no events
        for (const auto& [number, p_object] : crowd.inactive) p_object->setActive();
        crowd.inactive.clear();
        Object* p_object = crowd.any();
        crowd.inactive[crowd.numbers[p_object]] = p_object;
        p_object->setActive(false);
        if (auto* p_guest = dynamic_cast<Guest*>(p_object)) p_guest->open.clear();
      }
      if (tick % 50 == 49)
        PM.setAccuracy(PM.getAccuracy() == ACCURACY_FAST ? ACCURACY_DEFAULT : ACCURACY_FAST);
      own.world.update();
      ASSERT_FALSE(HasFailure()) << "round " << round << " tick " << tick;
    }
    crowd.is_over = true;
    for (const auto& [number, p_object] : crowd.living) p_object->setPosition(Vector(30 * number, -1000));
    PM.setGravity(Vector());
    for (int i = 0; i < 5; ++i) own.world.update();
    for (const auto& [number, p_object] : crowd.living) {
      const auto* p_guest = dynamic_cast<const Guest*>(p_object);
      EXPECT_TRUE(p_guest == nullptr || p_guest->open.empty()) << "round " << round << ' ' << number;
    }
    EXPECT_GT(crowd.ends, 50);
    while (!crowd.living.empty()) delete crowd.living.begin()->second;
  }
}

}  // namespace
}  // namespace df::test
