#include <memory>

#include "engine/world/ObjectList.h"
#include "engine/world/ObjectListIterator.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class ObjectListTest : public WorldTest {
 protected:
  std::vector<std::unique_ptr<Object>> make(int count) {
    std::vector<std::unique_ptr<Object>> objects;
    for (int i = 0; i < count; ++i) objects.push_back(std::make_unique<Object>());
    return objects;
  }
};

TEST_F(ObjectListTest, BeginsEmptyAndIsNeverFull) {
  ObjectList list;
  EXPECT_TRUE(list.isEmpty());
  EXPECT_FALSE(list.isFull());
  EXPECT_EQ(list.getCount(), 0);
  EXPECT_EQ(list[0], nullptr);
  EXPECT_EQ(list[-1], nullptr);
  EXPECT_EQ(list.insert(nullptr), -1);
}

TEST_F(ObjectListTest, KeepsOrderAcrossTheInlineLimit) {
  const auto objects = make(40);
  ObjectList list;
  for (const auto& p : objects) EXPECT_EQ(list.insert(p.get()), 0);
  for (int i = 0; i < 40; ++i) EXPECT_EQ(list[i], objects[i].get());
  // Removes from the front until the list is empty, across the inline limit.
  for (int left = 40; left > 0; --left) {
    EXPECT_EQ(list.remove(objects[40 - left].get()), 0);
    ASSERT_EQ(list.getCount(), left - 1);
    for (int i = 0; i < left - 1; ++i) ASSERT_EQ(list[i], objects[40 - left + 1 + i].get());
  }
  EXPECT_EQ(list.remove(objects[0].get()), -1);
  EXPECT_EQ(list.insert(objects[3].get()), 0);
  EXPECT_EQ(list[0], objects[3].get());
}

TEST_F(ObjectListTest, DeletedObjectsReadAsNullDespiteSlotReuse) {
  auto objects = make(2);
  ObjectList list;
  for (const auto& p : objects) list.insert(p.get());
  const std::uint32_t slot = objects[0]->key().slot;
  objects[0].reset();
  for (std::uint64_t i = 0; i < WorldStore::kSlotReuseDelay; ++i) WM.update();
  const auto successors = make(3);
  ASSERT_EQ(successors[0]->key().slot, slot);
  EXPECT_EQ(list.getCount(), 2);
  EXPECT_EQ(list[0], nullptr);
  EXPECT_EQ(list[1], objects[1].get());
}

TEST_F(ObjectListTest, CopiesMovesAndConcatenates) {
  const auto objects = make(30);
  ObjectList a;
  ObjectList b;
  for (int i = 0; i < 10; ++i) a.insert(objects[i].get());
  for (int i = 10; i < 30; ++i) b.insert(objects[i].get());
  const ObjectList sum = a + b;
  ASSERT_EQ(sum.getCount(), 30);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(sum[i], objects[i].get());
  EXPECT_EQ(a.getCount(), 10);
  a += a;
  ASSERT_EQ(a.getCount(), 20);
  EXPECT_EQ(a[19], objects[9].get());
  ObjectList moved = std::move(a);
  EXPECT_EQ(moved.getCount(), 20);
  b = moved;
  moved.clear();
  EXPECT_EQ(b.getCount(), 20);
  EXPECT_TRUE(moved.isEmpty());
}

TEST_F(ObjectListTest, AcceptsObjectsOfOneWorldOnly) {
  Object here;
  World other;
  const World::Scope scope_of_other(other);
  Object there;
  ObjectList list;
  EXPECT_EQ(list.insert(&here), 0);
  EXPECT_EQ(list.insert(&there), -1);
  EXPECT_EQ(list.remove(&there), -1);
}

TEST_F(ObjectListTest, IteratorVisitsAllInOrder) {
  const auto objects = make(20);
  ObjectList list;
  for (const auto& p : objects) list.insert(p.get());
  ObjectListIterator li(&list);
  int i = 0;
  for (li.first(); !li.isDone(); li.next()) EXPECT_EQ(li.currentObject(), objects[i++].get());
  EXPECT_EQ(i, 20);
  EXPECT_EQ(li.currentObject(), nullptr);
  ObjectListIterator none(nullptr);
  EXPECT_TRUE(none.isDone());
}

TEST_F(ObjectListTest, IteratorSkipsDeletedObjectsAndSurvivesDeletion) {
  auto objects = make(6);
  ObjectList list;
  for (const auto& p : objects) list.insert(p.get());
  objects[0].reset();
  objects[5].reset();
  std::vector<int> visited;
  ObjectListIterator li(&list);
  for (li.first(); !li.isDone(); li.next()) {
    for (int i = 0; i < 6; ++i) {
      if (objects[i] && objects[i].get() == li.currentObject()) {
        visited.push_back(i);
        objects[i].reset();
        if (i == 2) objects[3].reset();
        EXPECT_EQ(li.isDone(), i == 4);  // calling isDone() within the loop skips none
        break;
      }
    }
  }
  EXPECT_EQ(visited, (std::vector<int>{1, 2, 4}));
}

TEST_F(ObjectListTest, WorldQueriesAreInCreationOrder) {
  Probe a("x");
  Probe b("y");
  Probe c("x");
  Probe asleep("x");
  asleep.setActive(false);
  b.setSolidness(SPECTRAL);
  EXPECT_EQ(WM.getAllObjects().getCount(), 3);
  EXPECT_EQ(WM.getAllObjects(true).getCount(), 4);
  const ObjectList x = WM.objectsOfType("x");
  ASSERT_EQ(x.getCount(), 2);
  EXPECT_EQ(x[0], &a);
  EXPECT_EQ(x[1], &c);
  EXPECT_EQ(WM.solidObjects().getCount(), 2);
  EXPECT_EQ(WM.removeObject(&a), 0);
  EXPECT_EQ(WM.removeObject(&a), -1);
  EXPECT_EQ(WM.getAllObjects()[0], &b);
  EXPECT_EQ(WM.insertObject(&a), 0);
  EXPECT_EQ(WM.getAllObjects()[2], &a) << "one that returns is the last";
}

}  // namespace
}  // namespace df::test
