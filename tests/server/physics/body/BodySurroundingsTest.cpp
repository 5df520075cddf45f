#include "engine/world/WorldStore.h"
#include "physics/body/BodySurroundings.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

using naiad::physics::BodySurroundings;
using BodySurrounding = BodyScene;

struct Answer {
  std::size_t number;
  ObjectKey key;
  bool operator==(const Answer&) const = default;
};

// Searches each region by itself; this is the reference.
std::vector<Answer> oneByOne(const WorldStore& store, const std::vector<FixedBox>& regions) {
  std::vector<Answer> all;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    std::vector<ObjectKey> found;
    store.touching(regions[i], ~WorldStore::Slot{0}, found);
    for (const ObjectKey key : found) {
      if (!store.has(key.slot, WorldStore::kBody)) all.push_back({i, key});
    }
  }
  return all;
}

std::vector<Answer> together(BodySurroundings& surroundings, const WorldStore& store,
                             const std::vector<FixedBox>& regions) {
  std::vector<Answer> all;
  surroundings.clear();
  for (const FixedBox& region : regions) surroundings.addRegion(region);
  surroundings.query(store, [&](std::size_t number, ObjectKey key) { all.push_back({number, key}); });
  return all;
}

FixedBox boxAt(Vector corner, Vector size) {
  return {*toFixed(corner), *toFixed(size)};
}

// Heaps and single Objects, small and large, on both sides of the origin, at whole and fractional cells.
TEST_F(BodySurrounding, BatchSearchMatchesSingleSearches) {
  naiad::SplitMix64 random(11);
  const auto in = [&](double least, double most) { return least + (most - least) * random.unit(); };
  for (int i = 0; i < 150; ++i) {
    Object* p_object = i % 3 == 0 ? new Body : new Object;
    p_object->setSolidness(i % 5 == 0 ? SOFT : i % 7 == 0 ? SPECTRAL : HARD);
    const double width = in(0, 6), x = in(-30, 30);
    p_object->setBox(Box(Vector(in(-3, 0), -1), width, i % 11 == 0 ? 30 : 2));
    p_object->setPosition(i % 2 == 0 ? Vector(x, in(-30, 30)) : Vector(i % 40 - 20, i % 17 - 8));
  }
  BodySurroundings surroundings;
  std::size_t answers = 0;
  for (int round = 0; round < 50; ++round) {
    std::vector<FixedBox> regions;
    for (int i = 0; i < 60; ++i) {
      const double size = i % 9 == 0 ? 40 : i % 4;
      const double spread = round % 2 == 0 ? 3 : 40;
      const double y = in(-spread, spread);
      const Vector at(in(-spread, spread), y);
      regions.push_back(boxAt(at, Vector(size, i % 3)));
    }
    const std::vector<Answer> expected = oneByOne(world.store(), regions);
    ASSERT_EQ(together(surroundings, world.store(), regions), expected) << round;
    answers += expected.size();
  }
  EXPECT_GT(answers, 5000u);
}

TEST_F(BodySurrounding, OnlyNonBodyObjectsAreFound) {
  crate(Vector(1, 1));
  crate(Vector(2, 2));
  BodySurroundings surroundings;
  EXPECT_TRUE(together(surroundings, world.store(), {}).empty());
  EXPECT_TRUE(together(surroundings, world.store(), {boxAt(Vector(0, 0), Vector(5, 5))}).empty());
  const Object* p_wall = wall(Vector(4, 4), Vector(1, 1));
  const std::vector<Answer> found = together(
      surroundings, world.store(), {boxAt(Vector(9, 9), Vector(1, 1)), boxAt(Vector(2, 2), Vector(1, 1))});
  EXPECT_EQ(found, (std::vector<Answer>{{1, p_wall->key()}}));  // because edges that touch count
}

}  // namespace
}  // namespace df::test
