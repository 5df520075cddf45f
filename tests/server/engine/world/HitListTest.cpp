#include <algorithm>
#include <cmath>
#include <random>

#include "engine/world/CollisionRule.h"
#include "engine/world/HitList.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

/// Compares the grid's hits on random paths, also longer than those of the oracle's worlds, with a test of
/// all Objects.
class Hits : public WorldTest {
 protected:
  double within(double low, double high) { return std::uniform_real_distribution<>(low, high)(random); }
  bool oneIn(int n) { return std::uniform_int_distribution<>(1, n)(random) == 1; }

  /// Adds Objects of sizes up to `size`, at most `extent` cells from `centre` on each axis.
  void crowd(int count, Vector centre, double extent, double size) {
    for (int i = 0; i < count; ++i) {
      auto* p = new Object;
      const double x = centre.x() + within(-extent, extent);
      const double y = centre.y() + within(-extent, extent);
      // Objects on whole and half cells often touch at edges and at equal times.
      p->setPosition(oneIn(2) ? Vector(std::round(2 * x) / 2, std::round(2 * y) / 2) : Vector(x, y));
      if (!oneIn(3)) p->setBox(Box(Vector(within(-size, size), -1), within(0, size), within(0, size)));
      p->setSolidness(oneIn(4) ? HARD : SOFT);
      p->setPrecise(oneIn(10));
      if (oneIn(20)) p->setMask({"# #", " # "});
      if (oneIn(20)) p->setActive(false);
      objects.push_back(p);
    }
  }

  std::vector<Hit> lookAtAll(const Object& mover, const SweepPath& path, HitList::End end, Moment since,
                             const ObjectKeySet& met) const {
    const WorldStore& store = world.store();
    std::vector<Hit> hits;
    std::optional<Moment> last;
    for (const Object* p : objects) {
      const ObjectKey key = p->key();
      if (p == &mover || !store.collides(key.slot) || met.contains(key)) continue;
      const CollisionRule pair(store, mover.key().slot, key.slot);
      const auto moment = pair.firstCollision(path.sweep());
      if (!moment || *moment < since) continue;
      hits.push_back({*moment, store.order(key.slot), key});
      const bool ends = end == HitList::kFirst || pair.blocks(path.from(), path.to());
      if (ends && (!last || *moment < *last)) last = *moment;
    }
    std::erase_if(hits, [&](const Hit& hit) { return last && hit.moment > *last; });
    std::stable_sort(hits.begin(), hits.end(),
                     [](const Hit& a, const Hit& b) { return a.moment < b.moment; });
    return hits;
  }

  void compare(Object& mover, Vector to, HitList::End end) {
    const WorldStore& store = world.store();
    const ObjectKey key = mover.key();
    const SweepPath path(store.box(key.slot), store.position(key.slot), *toFixed(to));
    Moment since;
    ObjectKeySet met;
    for (int stage = 0; stage < 4; ++stage) {
      const std::vector<Hit> expected = lookAtAll(mover, path, end, since, met);
      list.fill(store, key.slot, path, end, since, &met);
      ASSERT_EQ(list.hits().size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_EQ(list.hits()[i].key, expected[i].key);
        ASSERT_EQ(list.hits()[i].moment, expected[i].moment);
      }
      found += expected.size();
      if (!list.end()) return;
      since = *list.end();
      for (const Hit& hit : expected) met.insert(hit.key);
    }
  }

  void compareMany(Vector centre, double extent, double reach, int count) {
    auto* p_mover = new Object;
    objects.push_back(p_mover);
    for (int i = 0; i < count && !HasFatalFailure(); ++i) {
      p_mover->setPosition(
          Vector(centre.x() + std::round(within(-extent, extent)), centre.y() + within(-extent, extent)));
      p_mover->setBox(oneIn(2) ? Box(Vector(-0.5, -0.5), 1, 1)
                               : Box(Vector(-2, 0), within(0, 12), within(0, 5)));
      p_mover->setNoSoft(oneIn(4));
      p_mover->setMayMoveOut(oneIn(2));
      p_mover->setSolidness(oneIn(3) ? SOFT : HARD);
      const double length = reach * within(0, 1) * within(0, 1);
      const double angle = oneIn(3) ? std::round(within(0, 8)) * 0.785398 : within(0, 6.3);
      const Vector to = p_mover->getPosition() + Vector(length * std::cos(angle), length * std::sin(angle));
      compare(*p_mover, to, oneIn(4) ? HitList::kFirst : HitList::kBlock);
    }
  }

  std::mt19937 random{1};
  std::vector<const Object*> objects;
  HitList list;
  std::size_t found = 0;
};

TEST_F(Hits, AllHitsOfManySizesAreFoundInOrder) {
  crowd(150, Vector(), 60, 3);
  crowd(30, Vector(), 80, 60);
  crowd(5, Vector(), 80, 900);
  compareMany(Vector(), 90, 300, 2000);
  EXPECT_GT(found, 2000u);
}

TEST_F(Hits, AllHitsOfFastMoversAreFoundInOrder) {
  crowd(300, Vector(), 500, 30);
  compareMany(Vector(), 500, 1e6, 500);
  compareMany(Vector(), 500, 1e9, 500);
  EXPECT_GT(found, 500u);
}

TEST_F(Hits, HitsAtTheNumberLimitAreFoundInOrder) {
  crowd(300, Vector(1999999900, -1999999900), 60, 30);
  compareMany(Vector(1999999900, -1999999900), 60, 40, 500);
  EXPECT_GT(found, 500u);
}

TEST_F(Hits, PathAcrossTheWorldFindsItsHits) {
  crowd(300, Vector(), 3, 10);
  auto* p_mover = new Object;
  objects.push_back(p_mover);
  for (const double y : {2e9, 0.25, -2e9}) {
    for (const double x : {2e9, 0.5, -2e9}) {
      p_mover->setPosition(Vector(x, y));
      for (const auto end : {HitList::kBlock, HitList::kFirst}) compare(*p_mover, Vector(-x, -y), end);
    }
  }
  EXPECT_GT(found, 4u);
}

}  // namespace
}  // namespace df::test
