// Invalid and extreme use of each kind of body. Every body stays bounded, and repeated runs are identical. A
// body that cannot be computed is frozen, counted and logged, and affects no other body.

#include <bit>
#include <cstdint>

#include "physics/body/SoftObject.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/support/NotANumber.h"
#include "tests/support/Sanitizers.h"

namespace df::test {
namespace {

using Bits = std::vector<std::uint64_t>;

using Made = std::vector<Object*>;

// A kind of body and a function that makes one. For joined bodies, it also makes the partner.
struct Kind {
  const char* p_name;
  Made (*make)(Vector where);
  bool is_dear = false;
};

Body* turning(Vector where) {
  auto* p_body = new Body;
  p_body->setTurning();
  p_body->setPosition(where);
  return p_body;
}

Body* compound(Vector where) {
  Body* p_body = turning(where);
  p_body->setBoxShape(2, 1);
  p_body->addBoxShape(1, 3, Vector(1, 1));
  p_body->addCircle(0.7, Vector(-1, 0));
  return p_body;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"box", [](Vector where) -> Made { return {BodyScene::crate(where)}; }},
      {"circle", [](Vector where) -> Made { return {BodyScene::ball(where, Vector())}; }},
      {"turning box",
       [](Vector where) -> Made {
         Body* p_body = turning(where);
         p_body->setBoxShape(2, 1);
         return {p_body};
       }},
      {"polygon",
       [](Vector where) -> Made {
         Body* p_body = turning(where);
         p_body->setPolygon({Vector(-1, -1), Vector(1, -1), Vector(0, 1)});
         return {p_body};
       }},
      {"compound", [](Vector where) -> Made { return {compound(where)}; }, true},
      {"on a rod",
       [](Vector where) -> Made {
         Body* p_body = BodyScene::ball(where, Vector());
         Body* p_partner = BodyScene::ball(where + Vector(3, 0), Vector());
         PM.addDistance(p_body, p_partner);
         return {p_body, p_partner};
       }},
      {"on a hinge",
       [](Vector where) -> Made {
         Body* p_body = compound(where);
         Body* p_partner = compound(where + Vector(4, 0));
         PM.addHinge(p_body, p_partner, where + Vector(2, 0));
         return {p_body, p_partner};
       },
       true},
      {"rope", [](Vector where) -> Made { return {new Rope(where, where + Vector(6, 0))}; }},
      {"beam", [](Vector where) -> Made { return {new Beam(where, where + Vector(6, 0))}; }},
      {"cloth", [](Vector where) -> Made { return {new Cloth(where, 5, 3)}; }},
      {"blob", [](Vector where) -> Made { return {new Blob(where, 1.5)}; }},
  };
  return all;
}

// Calls a function with the Body or SoftBody that the Object is.
template <class Call>
auto with(Object* p_object, Call call) {
  if (auto* p_body = dynamic_cast<Body*>(p_object)) return call(*p_body);
  return call(*static_cast<SoftBody*>(p_object));
}

bool isFrozen(Object* p_object) {
  return with(p_object, [](const auto& its) { return its.isFrozen(); });
}

void add(Bits& bits, Vector v) {
  bits.push_back(std::bit_cast<std::uint64_t>(v.x()));
  bits.push_back(std::bit_cast<std::uint64_t>(v.y()));
}

// A world with all kinds of bodies, far from the place at which the tests misuse a body.
class Witnesses : public OwnWorld {
 public:
  Witnesses() : OwnWorld(1, Vector(0, 0.01)) {
    BodyScene::wall(Vector(1000, 5), Vector(100, 5));
    for (int i = 0; i < 3; ++i) m_all.push_back(BodyScene::crate(Vector(950, -0.6 - 1.2 * i)));
    for (int i = 0; i < 3; ++i) m_all.push_back(compound(Vector(960, -3 - 4 * i)));
    Body* p_bob = BodyScene::ball(Vector(975, -10), Vector());
    PM.addDistance(nullptr, p_bob, Vector(970, -10), Vector(975, -10));
    m_all.push_back(p_bob);
    m_all.push_back(new Blob(Vector(985, -3), 2));
    auto* p_rope = new Rope(Vector(1000, -8), Vector(1010, -8));
    p_rope->pin(0);
    m_all.push_back(p_rope);
  }
  void ticks(int n) {
    for (int i = 0; i < n; ++i) {
      world.update();
      for (const Object* p_object : m_all) {
        add(seen, p_object->getPosition());
        add(seen, p_object->getVelocity());
      }
    }
  }

  Bits seen;

 private:
  std::vector<const Object*> m_all;
};

const Bits& undisturbed(int ticks) {
  static std::vector<Bits> known(100);
  Bits& bits = known[static_cast<std::size_t>(ticks)];
  if (bits.empty()) {
    Witnesses alone;
    alone.ticks(ticks);
    bits = alone.seen;
  }
  return bits;
}

// The strongest allowed impulse gives a body nearly the maximum speed, away from the others. It flies or is
// frozen, without an effect on other bodies.
TEST(BodyExtremes, StrongestAllowedImpulseAffectsNoOtherBody) {
  constexpr int kTicks = 20;
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.p_name);
    const auto run = [&] {
      Witnesses those;
      std::vector<Object*> hurt;
      for (int i = 0; i < 12; ++i) hurt.push_back(kind.make(Vector(1.5 * i - 1e8, -40)).front());
      for (std::size_t i = 0; i < hurt.size(); ++i) {
        const double angle = 0.5 * static_cast<double>(i);
        const Vector impulse(-9e5 * std::fabs(std::cos(angle)), 9e5 * std::sin(angle));
        EXPECT_EQ(with(hurt[i], [&](auto& its) { return its.applyImpulse(impulse); }), 0);
      }
      those.ticks(kTicks);
      Bits bits;
      for (const Object* p_object : hurt) {
        EXPECT_TRUE(std::isfinite(p_object->getPosition().x()) && std::isfinite(p_object->getPosition().y()));
        add(bits, p_object->getPosition());
        add(bits, p_object->getVelocity());
      }
      EXPECT_EQ(those.seen, undisturbed(kTicks));
      return bits;
    };
    EXPECT_EQ(run(), run());
  }
}

// If a force of 1e30 is accepted, it gives a free body the maximum speed, and a jointed or soft body is
// frozen. Both are counted, and the log names them. Otherwise the force is refused.
TEST(BodyExtremes, ExcessiveForceAffectsOnlyItsBody) {
  constexpr int kTicks = 20;
  for (const Kind& kind : kinds()) {
    SCOPED_TRACE(kind.p_name);
    Witnesses those;
    const Made made = kind.make(Vector(0, -40));
    Object* p_pushed = made.front();
    those.ticks(5);
    const std::uint64_t refusals = those.world.log().refusals();
    const bool is_taken = with(p_pushed, [](auto& its) { return its.applyForce(Vector(1e30, -1e30)); }) == 0;
    those.ticks(kTicks - 5);
    const bool is_free = dynamic_cast<const Body*>(p_pushed) != nullptr && made.size() == 1;
    EXPECT_EQ(isFrozen(p_pushed), is_taken && !is_free);
    EXPECT_EQ(PM.getQuarantineCount() > 0, is_taken && !is_free);
    EXPECT_EQ(PM.getLimitCount() > 0, is_taken && is_free);
    EXPECT_EQ(those.lines.empty(), !is_taken && those.world.log().refusals() == 0);
    EXPECT_EQ(those.world.log().refusals() - refusals, is_taken ? 0u : 1u);
    EXPECT_EQ(p_pushed->getVelocity().x() != 0, is_taken && is_free);
    EXPECT_EQ(those.seen, undisturbed(kTicks));
  }
}

// Problem 18 of the laboratory (docs/physics/lab.md).
TEST(BodyExtremes, InvalidNumbersAffectNoOtherBody) {
  const auto run = [&](int poison) {
    OwnWorld there;
    BodyScene::layFloor();
    auto* p_bad = poison > 0 ? BodyScene::crate(Vector(20, -3)) : nullptr;
    std::vector<Body*> crates;
    for (int i = 0; i < 5; ++i) crates.push_back(BodyScene::crate(Vector(0.1 * i, -0.6 - 1.2 * i)));
    if (poison == 1) p_bad->setVelocity(Vector(kNan, 0));
    if (poison == 2) p_bad->applyForce(Vector(1e30, 1e30));
    if (poison == 3) p_bad->setVelocity(Vector(1e7, 1e7));
    if (poison == 4) p_bad->setMass(1e-30), p_bad->applyForce(Vector(1e30, 0));
    if (poison == 5) p_bad->setMass(1e30), p_bad->applyForce(Vector(0, 1e30));
    if (poison == 6) p_bad->setSpring(Vector(1e9, 0), 1e30, 1e30);
    if (poison == 7) p_bad->setBox(Box(Vector(), 0, 0)), p_bad->setBoxShape();
    return there.states(60, crates);
  };
  const auto right = run(0);
  for (int poison = 1; poison <= 7; ++poison) EXPECT_EQ(run(poison), right) << poison;
}

// Hundreds of bodies of one kind in one place. None is thrown away or frozen, and repeated runs are
// identical.
class InOnePlace : public testing::TestWithParam<Kind> {};

TEST_P(InOnePlace, HundredsOfBodiesStayBounded) {
  constexpr int kTicks = 5;
  const int many = (GetParam().is_dear ? 100 : 200) / (naiad::test::kSanitized ? 2 : 1);
  constexpr double kFall = 0.01 * kTicks, kFastest = 10;
  const auto run = [&] {
    Witnesses those;
    Made all;
    while (static_cast<int>(all.size()) < many) {
      for (Object* p_object : GetParam().make(Vector(0, -40))) all.push_back(p_object);
    }
    those.ticks(kTicks);
    Bits bits;
    double momentum = 0;
    for (Object* p_object : all) {
      const Vector velocity = p_object->getVelocity();
      EXPECT_LT(velocity.getMagnitude(), kFastest);
      EXPECT_FALSE(isFrozen(p_object));
      momentum += velocity.y();
      add(bits, p_object->getPosition());
      add(bits, velocity);
    }
    EXPECT_NEAR(momentum / many, kFall, 0.01);  // the centre of mass falls
    EXPECT_EQ(those.seen, undisturbed(kTicks));
    EXPECT_LE(those.lines.size(), 1u);  // only the message about crowded soft bodies is allowed
    return bits;
  };
  EXPECT_EQ(run(), run());
}

std::string nameOf(const testing::TestParamInfo<Kind>& of) {
  std::string name = of.param.p_name;
  std::erase(name, ' ');
  return name;
}

INSTANTIATE_TEST_SUITE_P(EveryKind, InOnePlace, testing::ValuesIn(kinds()), nameOf);

}  // namespace
}  // namespace df::test
