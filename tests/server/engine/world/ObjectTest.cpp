#include <memory>
#include <new>
#include <optional>
#include <stdexcept>

#include "tests/server/engine/Probe.h"
#include "tests/support/NotANumber.h"

namespace df::test {
namespace {

class ObjectTest : public WorldTest {};

TEST_F(ObjectTest, DefaultsMatchTheBook) {
  Object o;
  EXPECT_EQ(o.getType(), "Object");
  expectAt(o, 0, 0);
  EXPECT_EQ(o.getAltitude(), 2);
  EXPECT_EQ(o.getSolidness(), HARD);
  EXPECT_TRUE(o.isSolid());
  EXPECT_FALSE(o.getNoSoft());
  EXPECT_EQ(o.getSpeed(), 0);
  EXPECT_EQ(o.getDirection(), Vector(0, 0));
  EXPECT_EQ(o.getBox(), Box(Vector(-0.5, -0.5), 1, 1));
  EXPECT_TRUE(o.isActive());
  EXPECT_TRUE(o.isVisible());
  EXPECT_EQ(o.getWorld(), &world);
}

TEST_F(ObjectTest, VelocityIsDirectionTimesSpeed) {
  Object o;
  o.setSpeed(0.25);
  o.setDirection(Vector(-1, 0));
  EXPECT_EQ(o.getVelocity(), Vector(-0.25, 0));
  o.setDirection(Vector(0, 2));  // not normalised
  EXPECT_EQ(o.getVelocity(), Vector(0, 0.5));
  o.setSpeed(1);
  EXPECT_EQ(o.getDirection(), Vector(0, 2));
  EXPECT_EQ(o.predictPosition(), Vector(0, 2));
}

TEST_F(ObjectTest, SetVelocitySetsSpeedAndDirection) {
  Object o;
  o.setVelocity(Vector(3, 4));
  EXPECT_EQ(o.getSpeed(), 5);
  EXPECT_EQ(o.getDirection(), Vector(0.6, 0.8));
  EXPECT_EQ(o.getVelocity(), Vector(3, 4));
  o.setSpeed(10);
  EXPECT_EQ(o.getVelocity(), Vector(6, 8));
  o.setVelocity(Vector(0, 0));
  EXPECT_EQ(o.getSpeed(), 0);
  EXPECT_EQ(o.getDirection(), Vector(0, 0));
}

TEST_F(ObjectTest, SettersRefuseNonFiniteAndOutOfRangeValues) {
  Probe o("refuser");
  o.setPosition(Vector(1, 2));
  o.setVelocity(Vector(1, 0));
  std::uint64_t refused = 7;  // those after the loop
  for (const double x : {kNan, kInfinity, -kInfinity, 1e30}) {
    for (const Vector v : {Vector(x, 0), Vector(0, x)}) {
      EXPECT_EQ(o.setPosition(v), -1);
      EXPECT_EQ(o.setVelocity(v), -1);
      EXPECT_EQ(o.setAcceleration(v), -1);
      EXPECT_EQ(o.setDirection(v), -1);
      EXPECT_EQ(o.setBox(Box(v, 1, 1)), -1);
      EXPECT_EQ(WM.moveObject(&o, v), -1);
      refused += 6;
    }
    EXPECT_EQ(o.setBox(Box(Vector(), x, 1)), -1);
    EXPECT_EQ(o.setSpeed(x), -1);
    refused += 2;
  }
  EXPECT_EQ(o.setPosition(Vector(0, 2.1e9)), -1);
  EXPECT_EQ(o.setVelocity(Vector(2e7, 0)), -1);
  EXPECT_EQ(o.setBox(Box(Vector(0, 0), -1, 1)), -1);
  EXPECT_EQ(o.setBox(Box(Vector(0, 0), 1, 2e6)), -1);
  EXPECT_EQ(o.setAltitude(5), -1);
  EXPECT_EQ(o.setAltitude(-1), -1);
  EXPECT_EQ(o.setSolidness(static_cast<Solidness>(7)), -1);
  expectAt(o, 1, 2);
  EXPECT_EQ(o.getVelocity(), Vector(1, 0));
  EXPECT_EQ(o.getSpeed(), 1);
  EXPECT_EQ(o.getAltitude(), 2);
  EXPECT_EQ(o.getSolidness(), HARD);
  EXPECT_EQ(world.log().refusals(), refused);
  EXPECT_EQ(logged("of refuser"), 9) << "each setter once";
}

TEST_F(ObjectTest, StackObjectsAreRemovedButNotDeleted) {
  Probe o("automatic");
  WM.markForDelete(&o);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 0);
  EXPECT_EQ(logged("automatic"), 1);
  EXPECT_EQ(o.setPosition(Vector(3, 3)), 0);
  expectAt(o, 3, 3);
  EXPECT_EQ(WM.markForDelete(&o), -1);
  EXPECT_EQ(WM.moveObject(&o, Vector()), -1);
  EXPECT_EQ(WM.insertObject(&o), 0);
  EXPECT_EQ(world.store().countInWorld(), 1);
}

struct Owner : Probe {
  explicit Owner(Object* p_first = nullptr) : p_child(p_first) {}
  Object member;
  Object* p_child;
};

TEST_F(ObjectTest, WorldDeletesOnlyObjectsMadeWithNew) {
  auto* p_owner = new Owner(new Probe("child"));  // the inner `new` runs while the outer is pending
  EXPECT_EQ(world.store().countInWorld(), 3);
  WM.markForDelete(&p_owner->member);  // inside a heap block, but not the block itself
  WM.markForDelete(p_owner->p_child);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 1);
  WM.markForDelete(p_owner);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

TEST_F(ObjectTest, MarkingArrayOptionalAndMixinObjectsIsSafe) {
  struct Mixin {
    virtual ~Mixin() = default;
    long padding[4] = {};
  };
  struct Mixed : Mixin, Object {};
  Object* p_mixed = new Mixed;
  WM.markForDelete(p_mixed);
  std::optional<Probe> in_place(std::in_place);
  WM.markForDelete(&*in_place);
  auto* p_array = new Probe[3];
  WM.markForDelete(&p_array[1]);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 2);
  delete[] p_array;
}

TEST_F(ObjectTest, ThrowingConstructorLeavesNoObject) {
  struct Bad : Object {
    Bad() { throw std::runtime_error("no"); }
  };
  EXPECT_THROW(new Bad, std::runtime_error);
  EXPECT_EQ(world.store().countInWorld(), 0);
}

struct alignas(64) Wide : Object {
  char bytes[64] = {};
};

TEST_F(ObjectTest, OverAlignedObjectsAreDeleted) {
  WM.markForDelete(new Wide);
  WM.markForDelete(new (std::nothrow) Probe);
  WM.update();
  EXPECT_EQ(world.store().countInWorld(), 0);
}

Probe& aStaticObject() {
  static Probe probe("static");
  return probe;
}

TEST(StaticObject, LivesInTheDefaultWorldAndSurvivesShutDown) {
  World& world = World::current();
  EXPECT_EQ(aStaticObject().getWorld(), &world);
  const ObjectKey before = aStaticObject().key();
  world.shutDown();
  EXPECT_EQ(world.store().find(before), nullptr);
  EXPECT_EQ(world.objects().insertObject(&aStaticObject()), 0);
  EXPECT_EQ(world.store().find(aStaticObject().key()), &aStaticObject());
}

TEST(ObjectOfAGoneWorld, IsSafeToUse) {
  std::optional<World> world(std::in_place);
  std::optional<World::Scope> scope(*world);
  auto p_o = std::make_unique<Probe>("orphan", nullptr, Vector(4, 5));
  ObjectList list;
  list.insert(p_o.get());
  scope.reset();
  world.reset();
  EXPECT_EQ(p_o->getWorld(), nullptr);
  expectAt(*p_o, 4, 5);
  EXPECT_EQ(p_o->setPosition(Vector(6, 7)), 0);
  EXPECT_EQ(p_o->setPosition(Vector(kNan, 7)), -1);
  expectAt(*p_o, 6, 7);
  EXPECT_EQ(p_o->registerInterest("x"), -1);
  EXPECT_EQ(list[0], nullptr);
  EXPECT_EQ(World::current().objects().insertObject(p_o.get()), -1);
  p_o.reset();
  list.clear();
}

}  // namespace
}  // namespace df::test
