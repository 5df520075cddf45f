#include "SweptWorld.h"

namespace df::test {
namespace {

class FirstContact : public SweptWorld {};

TEST_F(FirstContact, MovesNothingAndSendsNothing) {
  Probe* a = make("a", 10, 10);
  make("beside", 12, 12, SOFT);
  Probe* b = make("b", 20, 10, SOFT);
  make("c", 20, 10.5);
  const Contact contact = WM.firstContact(a, Vector(50, 10));
  EXPECT_EQ(contact.p_object, b);
  EXPECT_EQ(contact.time, 9.0 / 40);
  EXPECT_EQ(contact.position, Vector(19 - kUnit, 10));
  expectAt(*a, 10, 10);
  EXPECT_TRUE(received.empty());
}

TEST_F(FirstContact, ReturnsTheTargetWithoutAContact) {
  Probe* a = make("a", 10, 10);
  Probe* b = make("b", 20, 10);
  const auto expectNobody = [&](const Object* p_o, Vector where) {
    const Contact contact = WM.firstContact(p_o, where);
    EXPECT_EQ(contact.p_object, nullptr);
    EXPECT_EQ(contact.time, 1);
    EXPECT_EQ(contact.position, where);
  };
  expectNobody(a, Vector(10, 50));
  expectNobody(a, Vector(18.5, 10));
  expectNobody(nullptr, Vector(50, 10));
  expectNobody(a, Vector(3e9, 10));
  b->setActive(false);
  expectNobody(a, Vector(50, 10));
  b->setActive(true);
  a->setSolidness(SPECTRAL);
  expectNobody(a, Vector(50, 10));
  a->setSolidness(HARD);
  a->setActive(false);
  expectNobody(a, Vector(50, 10));
  a->setActive(true);
  WM.removeObject(a);
  expectNobody(a, Vector(50, 10));
  WM.insertObject(a);
  EXPECT_EQ(WM.firstContact(a, Vector(50, 10)).p_object, b);
}

}  // namespace
}  // namespace df::test
