#include <gtest/gtest.h>

#include "engine/world/ObjectRegistry.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/engine/world/Parts.h"

namespace df::test {
namespace {

class Counted : public Object {
 public:
  explicit Counted(int& deaths) : m_deaths(deaths) {}
  ~Counted() override { ++m_deaths; }

 private:
  int& m_deaths;
};

TEST(ObjectRegistry, ReturnedObjectIsLastInOrder) {
  Parts parts;
  Probe first("first");
  Probe second("second");
  EXPECT_EQ(parts.objects.removeObject(&first), 0);
  EXPECT_EQ(parts.objects.removeObject(&first), -1);
  EXPECT_EQ(parts.objects.getAllObjects().getCount(), 1);
  EXPECT_EQ(parts.objects.insertObject(&first), 0);
  EXPECT_EQ(parts.objects.getAllObjects()[1], &first);
}

TEST(ObjectRegistry, MarkedObjectDiesOnceWhenTheMarkedAreDeleted) {
  Parts parts;
  int deaths = 0;
  auto* p_object = new Counted(deaths);
  EXPECT_EQ(parts.objects.markForDelete(p_object), 0);
  EXPECT_EQ(parts.objects.markForDelete(p_object), 0);
  EXPECT_EQ(deaths, 0);
  parts.objects.deleteMarked();
  parts.objects.deleteMarked();
  EXPECT_EQ(deaths, 1);
}

TEST(ObjectRegistry, ObjectWithoutNewIsOnlyRemoved) {
  Parts parts;
  int deaths = 0;
  {
    Counted object(deaths);
    parts.objects.markForDelete(&object);
    parts.objects.deleteMarked();
    EXPECT_EQ(deaths, 0);
    EXPECT_FALSE(parts.objects.owns(&object));
    ASSERT_EQ(parts.lines.size(), 1u);
    EXPECT_NE(parts.lines[0].find("not made with new"), std::string::npos);
  }
  EXPECT_EQ(deaths, 1);
}

TEST(ObjectRegistry, ClearDeletesWhatDestructorsMake) {
  Parts parts;
  class Phoenix : public Object {
   public:
    explicit Phoenix(int lives) : m_lives(lives) {}
    ~Phoenix() override {
      if (m_lives > 0) new Phoenix(m_lives - 1);
    }

   private:
    int m_lives;
  };
  new Phoenix(3);
  parts.objects.clear();
  EXPECT_EQ(parts.store.countInWorld(), 0);
}

TEST(ObjectRegistry, ObjectOfAnotherStoreIsRefused) {
  Parts parts;
  Parts others;
  Object there;
  EXPECT_EQ(parts.objects.insertObject(&there), -1);
  EXPECT_EQ(parts.objects.removeObject(&there), -1);
  EXPECT_EQ(parts.objects.markForDelete(&there), -1);
  EXPECT_TRUE(parts.objects.getCollisions(&there, Vector()).isEmpty());
}

}  // namespace
}  // namespace df::test
