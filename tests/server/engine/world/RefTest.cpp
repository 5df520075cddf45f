#include <memory>

#include "engine/world/Ref.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class Reference : public WorldTest {};

TEST_F(Reference, PointsToItsObjectUntilDeletion) {
  auto* p = new Probe("a");
  const Ref<Probe> ref = p;
  EXPECT_EQ(ref.get(), p);
  EXPECT_EQ(&*ref, p);
  EXPECT_EQ(ref->getType(), "a");
  EXPECT_TRUE(ref);
  delete p;
  EXPECT_EQ(ref.get(), nullptr);
  EXPECT_FALSE(ref);
}

TEST_F(Reference, ReadsNullOnceTheObjectIsRemoved) {
  auto* p = new Probe;
  const Ref<Probe> before = p;
  WM.removeObject(p);
  const Ref<Probe> meanwhile = p;
  EXPECT_FALSE(before);
  EXPECT_FALSE(meanwhile);
  WM.insertObject(p);
  EXPECT_FALSE(before);
  EXPECT_EQ(meanwhile, p);
}

TEST_F(Reference, PointsToAMarkedObjectUntilUpdateEnds) {
  auto* p = new Probe;
  const Ref<Probe> ref = p;
  WM.markForDelete(p);
  EXPECT_EQ(ref, p);
  WM.update();
  EXPECT_FALSE(ref);
}

TEST_F(Reference, DoesNotMatchASuccessorAtTheSameAddress) {
  alignas(Probe) std::byte place[sizeof(Probe)];
  auto* p = new (place) Probe("a");
  const Ref<Probe> ref = p;
  p->~Probe();
  auto* p_next = new (place) Probe("b");
  EXPECT_EQ(static_cast<void*>(p), static_cast<void*>(p_next));
  EXPECT_FALSE(ref);
  EXPECT_NE(ref, p_next);
  p_next->~Probe();
}

TEST_F(Reference, ComparesByTheObject) {
  auto* a = new Probe;
  auto* b = new Probe;
  const Ref<Probe> ref = a;
  const Ref<Object> as_object = ref;
  const Object* p_object = a;
  EXPECT_TRUE(ref == a);
  EXPECT_TRUE(a == ref);
  EXPECT_TRUE(ref == p_object);
  EXPECT_TRUE(ref == as_object);
  EXPECT_TRUE(as_object == ref);
  EXPECT_TRUE(ref != b);
  EXPECT_TRUE(ref != nullptr);
  EXPECT_TRUE(ref != Ref<Probe>(b));
}

TEST_F(Reference, CopyMoveAndResetWork) {
  auto* a = new Probe;
  auto* b = new Probe;
  Ref<Probe> first = a;
  Ref<Probe> second = b;
  const Ref<Probe> copy = first;
  second = std::move(first);
  EXPECT_EQ(second, a);
  EXPECT_EQ(first, nullptr);  // NOLINT(bugprone-use-after-move): it is empty then
  EXPECT_EQ(copy, a);
  second = b;
  EXPECT_EQ(second, b);
  second = *&second;
  EXPECT_EQ(second, b);
  second = nullptr;
  EXPECT_EQ(second, nullptr);
  delete a;
  EXPECT_EQ(copy, nullptr);
}

TEST_F(Reference, WorksForConstObjectsInAVector) {
  std::vector<Ref<const Object>> refs;
  std::vector<Probe*> probes(10);
  for (Probe*& p : probes) p = new Probe;
  refs.assign(probes.begin(), probes.end());
  delete probes[3];
  for (std::size_t i = 0; i < refs.size(); ++i) EXPECT_EQ(static_cast<bool>(refs[i]), i != 3);
}

TEST_F(Reference, SurvivesTheWorldAndItsObjects) {
  Ref<Probe> ref;
  std::unique_ptr<Probe> p_left;
  {
    World other;
    const World::Scope in_it(other);
    p_left = std::make_unique<Probe>();
    ref = p_left.get();
    EXPECT_TRUE(ref);
  }
  EXPECT_FALSE(ref);
  const Ref<Probe> late = p_left.get();
  EXPECT_FALSE(late);
  p_left.reset();
  EXPECT_FALSE(ref);
}

}  // namespace
}  // namespace df::test
