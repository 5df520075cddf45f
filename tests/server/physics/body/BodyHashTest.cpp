// A world with bodies is a pure function of its seed: a long run with all kinds of bodies has one hash
// with every compiler.
#include <bit>
#include <cstdint>

#include "engine/events/EventOut.h"
#include "physics/body/Field.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BodyScene.h"

namespace df::test {
namespace {

class Whirl : public Field {
  Vector accelerationAt(Vector displacement, Vector velocity, double time) const override {
    return Vector(-0.01 * displacement.x() + 0.02 * velocity.y(),
                  -0.01 * displacement.y() - (0.02 + 1e-5 * time) * velocity.x());
  }
};

class Hashed {
 public:
  void take(std::uint64_t value) { m_hash = (m_hash ^ value) * 0x9E3779B97F4A7C15ull + (m_hash >> 29); }
  void take(double value) { take(std::bit_cast<std::uint64_t>(value)); }
  void take(Vector v) { take(v.x()), take(v.y()); }
  std::uint64_t value() const { return m_hash; }

 private:
  std::uint64_t m_hash = 1;
};

class Noisy : public Body {
 public:
  explicit Noisy(Hashed& hash) : m_hash(hash) {}
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      m_hash.take(static_cast<std::uint64_t>(p_c->getObject1()->getId()) << 32 |
                  static_cast<std::uint64_t>(p_c->getObject2()->getId()));
      m_hash.take(p_c->getImpulse());
    }
    if (p_e->getType() == CONTACT_END_EVENT) m_hash.take(std::uint64_t{7});
    if (p_e->getType() == OUT_EVENT) WM.markForDelete(this);
    return 1;
  }

 private:
  Hashed& m_hash;
};

constexpr std::uint64_t kHash = 17396102000387394471u;
constexpr std::uint64_t kFastHash = 14824206731382166997u;

std::uint64_t run(bool may_turn, int count, Accuracy accuracy = ACCURACY_DEFAULT) {
  OwnWorld own(2);
  Hashed hash;
  const Whirl whirl;
  naiad::SplitMix64 random(5);
  const auto any = [&](double size) { return size * (2 * random.unit() - 1); };
  PM.setAccuracy(accuracy);
  PM.setGravity(perSecondSquared(Vector(0, 20)));
  WM.setBoundary(Box(Vector(-40, -40), 120, 80));
  for (const Box& box : {Box(Vector(-40, 20), 120, 3), Box(Vector(-40, -20), 2, 40),
                         Box(Vector(60, -20), 2, 40), Box(Vector(10, 10), 8, 1)}) {
    (new Object)->setBox(box);
  }
  std::vector<Noisy*> bodies;
  for (int i = 0; i < count; ++i) {
    auto* p_body = new Noisy(hash);
    bodies.push_back(p_body);
    const double x = 10 + any(30), y = any(15);
    p_body->setPosition(Vector(x, y));
    const double vx = any(1), vy = any(0.5);
    p_body->setVelocity(Vector(vx, vy));
    p_body->setMass(0.5 + 4 * random.unit());
    p_body->setRestitution(random.unit());
    p_body->setFriction(random.unit());
    if (i % 3 == 0) p_body->setCircle(0.3 + random.unit());
    if (i % 5 == 0) p_body->setDrag(0.01, i % 2 == 0 ? 0.01 : 0);
    if (i % 7 == 0) p_body->setField(&whirl, Vector(10, 0));
    if (i % 11 == 0) p_body->setSolidness(SOFT);
    if (i % 13 == 0) p_body->setSolidness(SPECTRAL);
    if (i % 4 == 0) p_body->setContactEnds();
    if (i % 13 == 0 && i > 0 && !may_turn) bodies[static_cast<std::size_t>(i) - 1]->setSolidness(SPECTRAL);
    if (i % 13 == 0 && i > 0) PM.addRope(bodies[static_cast<std::size_t>(i) - 1], p_body);
    if (may_turn && i % 2 == 0) p_body->setTurning();
    if (may_turn && i % 6 == 1) p_body->setPolygon({Vector(-1, 0.4), Vector(1, 0.4), Vector(0, -0.5)});
  }
  for (int tick = 0; tick < 300; ++tick) {
    own.world.update();
    const ObjectList all = WM.getAllObjects();
    for (int i = 0; i < all.getCount(); ++i) {
      hash.take(static_cast<std::uint64_t>(all[i]->getId()));
      const auto* p_body = dynamic_cast<const Body*>(all[i]);
      if (p_body == nullptr) continue;
      hash.take(p_body->getPosition());
      hash.take(p_body->getVelocity());
      hash.take(p_body->getAngle());
    }
  }
  hash.take(PM.getQuarantineCount());
  return hash.value();
}

// The hash is equal for gcc and clang at every optimisation level. (RigidWorld is hashed in its own tests.)
TEST(BodyHash, IsTheSameOnEveryPlatform) {
  EXPECT_EQ(run(false, 50), kHash);
  EXPECT_EQ(run(true, 50, ACCURACY_FAST), kFastHash);
  EXPECT_EQ(run(true, 50), run(true, 50));
}

}  // namespace
}  // namespace df::test
