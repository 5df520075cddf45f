#include <set>

#include "physics/broadphase/BroadPhase.h"
#include "tests/server/physics/RandomShapes.h"
#include "tests/support/AllocationCount.h"

namespace naiad::physics {
namespace {

using namespace test;

// Bodies that fly in a field, some of them at rest, with their entries in the broad phase.
struct Body {
  Place place;
  Vec2 velocity;
  Vec2 half;
  bool moves = true;
  std::int32_t proxy = -1;
};

GridBounds tight(const Body& body) {
  return gridBounds(body.place, {-body.half, body.half}, 0);
}
GridBounds wide(const Body& body) {
  const double margin = 0.1 + 4 * std::max(std::fabs(body.velocity.x), std::fabs(body.velocity.y));
  return gridBounds(body.place, {-body.half, body.half}, margin);
}

std::vector<Body> someBodies(SplitMix64& random, int count, double field) {
  std::vector<Body> bodies;
  for (int i = 0; i < count; ++i) {
    Body body;
    const double size = random.unit() < 0.02 ? 10 : 1;
    const Vec2 at = {between(random, 0, field), between(random, 0, field)};
    body.place = placeAt(at);
    body.half = size * Vec2{between(random, 0.2, 1), between(random, 0.2, 1)};
    body.moves = random.unit() < 0.7;
    if (body.moves) body.velocity = anyVec(random, 0.5);
    bodies.push_back(body);
  }
  return bodies;
}

std::uint32_t idOf(std::size_t i) {
  return static_cast<std::uint32_t>(7 * i % 1009 + (i << 10));  // unique, and not in the order of creation
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs slowPairs(const BroadPhase& broad, const std::vector<Body>& bodies) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> found;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (bodies[i].proxy < 0 || bodies[j].proxy < 0 || !(bodies[i].moves || bodies[j].moves)) continue;
      if (!overlap(broad.bounds(bodies[i].proxy), broad.bounds(bodies[j].proxy))) continue;
      found.insert(std::minmax(idOf(i), idOf(j)));
    }
  }
  return {found.begin(), found.end()};
}

Pairs idsOf(std::span<const BroadPhasePair> pairs) {
  Pairs ids;
  for (const BroadPhasePair& pair : pairs) ids.emplace_back(pair.id_a, pair.id_b);
  return ids;
}

void step(BroadPhase& broad, std::vector<Body>& bodies) {
  for (Body& body : bodies) {
    if (body.proxy < 0 || !body.moves) continue;
    body.place = body.place + body.velocity;
    broad.move(body.proxy, tight(body), wide(body));
  }
}

TEST(BroadPhase, PairsMatchABruteForceSearchInOrder) {
  SplitMix64 random(1);
  BroadPhase broad;
  std::vector<Body> bodies = someBodies(random, 300, 40);
  std::size_t most = 0;
  for (int tick = 0; tick < 200; ++tick) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      Body& body = bodies[i];
      if (body.proxy < 0 && random.unit() < 0.3) {
        body.proxy = broad.add(idOf(i), wide(body), body.moves);
      } else if (body.proxy >= 0 && random.unit() < 0.02) {
        broad.remove(body.proxy);
        body.proxy = -1;
      }
      // Moves some bodies to another place.
      if (body.proxy >= 0 && random.unit() < 0.01) {
        body.place = body.place + anyVec(random, 30);
        broad.move(body.proxy, tight(body), wide(body));
      }
    }
    step(broad, bodies);
    const std::span<const BroadPhasePair> pairs = broad.updatePairs();
    ASSERT_EQ(idsOf(pairs), slowPairs(broad, bodies)) << tick;
    most = std::max(most, pairs.size());
    for (const BroadPhasePair& pair : pairs) {
      // Checks that each proxy belongs to its id.
      const auto has = [&](std::uint32_t id, std::int32_t proxy) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
          if (idOf(i) == id) return bodies[i].proxy == proxy;
        }
        return false;
      };
      ASSERT_TRUE(has(pair.id_a, pair.proxy_a) && has(pair.id_b, pair.proxy_b));
    }
  }
  EXPECT_GT(most, 300U);
}

TEST(BroadPhase, QueriesMatchABruteForceSearch) {
  SplitMix64 random(2);
  BroadPhase broad;
  std::vector<Body> bodies = someBodies(random, 500, 60);
  for (std::size_t i = 0; i < bodies.size(); ++i)
    bodies[i].proxy = broad.add(idOf(i), tight(bodies[i]), true);
  std::size_t hits = 0;
  for (int k = 0; k < 2000; ++k) {
    const GridBounds area = gridBounds(placeAt(anyVec(random, 60)), {{-2, -1}, {3, 4}}, 0);
    std::set<std::uint32_t> found, truth;
    broad.query(area, [&](std::uint32_t id) { EXPECT_TRUE(found.insert(id).second); });
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      if (overlap(area, tight(bodies[i]))) truth.insert(idOf(i));
    }
    EXPECT_EQ(found, truth);
    hits += truth.size();
  }
  EXPECT_GT(hits, 2000U);
}

TEST(BroadPhase, AllocatesNothingOnceWarm) {
  if (!naiad::test::canCountAllocations()) GTEST_SKIP() << "sanitizers have their own allocator";
  SplitMix64 random(4);
  BroadPhase broad;
  std::vector<Body> bodies = someBodies(random, 1000, 60);
  for (std::size_t i = 0; i < bodies.size(); ++i) bodies[i].proxy = broad.add(idOf(i), wide(bodies[i]), true);
  const auto there_and_back = [&] {
    for (int round = 0; round < 2; ++round) {
      for (int tick = 0; tick < 50; ++tick) {
        step(broad, bodies);
        broad.updatePairs();
      }
      for (Body& body : bodies) body.velocity = -body.velocity;
    }
  };
  for (int warm = 0; warm < 3; ++warm) there_and_back();
  const auto before = naiad::test::allocationsSoFar();
  there_and_back();
  EXPECT_EQ(naiad::test::allocationsSoFar(), before);
}

TEST(BroadPhase, GridBoundsEncloseTheShapeTightly) {
  SplitMix64 random(5);
  for (int i = 0; i < 10000; ++i) {
    const Vec2 at = anyVec(random, 100);
    const Bounds bounds = {-anyVec(random, 3), anyVec(random, 3)};
    const GridBounds grid = gridBounds(placeAt(at), bounds, 0.25);
    EXPECT_LE(static_cast<double>(grid.lower_x), kGridUnits * (at.x + bounds.lower.x - 0.25) + 1e-9);
    EXPECT_GE(static_cast<double>(grid.upper_y), kGridUnits * (at.y + bounds.upper.y + 0.25) - 1e-9);
    EXPECT_GE(static_cast<double>(grid.lower_x), kGridUnits * (at.x + bounds.lower.x - 0.25) - 1.01);
  }
}

}  // namespace
}  // namespace naiad::physics
