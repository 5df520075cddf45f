#include "physics/broadphase/BroadPhase.h"
#include "physics/geometry/Manifold.h"
#include "physics/geometry/Mass.h"
#include "physics/geometry/ShapeQuery.h"
#include "physics/geometry/TimeOfImpact.h"
#include "tests/server/physics/BitHash.h"
#include "tests/server/physics/RandomShapes.h"

namespace naiad::physics {
namespace {

// All geometry functions together have one hash, for every compiler and optimisation level.
TEST(Manifold, GeometryHashIsTheSameOnEveryPlatform) {
  SplitMix64 random(1);
  test::BitHash hash;
  BroadPhase broad;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const ConvexShape a = test::anyShape(random), b = test::anyShape(random);
    const RigidMotion motion_a = {test::anyVec(random, 5), test::anyRotation(random),
                                  test::between(random, -3, 3)};
    const RigidMotion motion_b = {test::anyVec(random, 5), test::anyRotation(random),
                                  test::between(random, -3, 3)};
    const Vec2 offset = test::anyVec(random, 2);
    const Mass mass = massOf(a, 2);
    hash.add(mass.mass), hash.add(mass.inertia), hash.add(mass.centre);
    Manifold m;
    if (collide(a, motion_a.start, b, motion_b.start, offset, 0.1, m)) {
      hash.add(m.normal);
      for (std::size_t k = 0; k < static_cast<std::size_t>(m.count); ++k) {
        hash.add(m.points[k].anchor_a), hash.add(m.points[k].separation),
            hash.add(std::uint64_t{m.points[k].id});
      }
    }
    const TimeOfImpact impact = timeOfImpact(a, motion_a, b, motion_b, 3 * offset);
    hash.add(impact.time), hash.add(impact.gap), hash.add(impact.normal);
    const RayHit hit = castRay(a, offset, motion_a.displacement);
    hash.add(hit.fraction), hash.add(hit.normal);
    RotatedShape placed;
    turn(a, motion_a.start, placed);
    broad.add(i, gridBounds(placeAt(10 * offset), boundsOf(placed), 0.1), true);
  }
  for (const BroadPhasePair& pair : broad.updatePairs()) hash.add(std::uint64_t{pair.id_a} << 32 | pair.id_b);
  EXPECT_EQ(hash.value(), 9358134255254305601U);
}

}  // namespace
}  // namespace naiad::physics
