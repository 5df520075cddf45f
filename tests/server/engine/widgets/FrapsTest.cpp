#include "engine/effects/Firework.h"
#include "engine/widgets/Fraps.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class FrapsTest : public WorldTest {
 protected:
  std::string topRow() { return world.picture().render(FixedVector()).rowText(1); }
};

TEST_F(FrapsTest, ShowsTheFrameRateUntilItIsHidden) {
  auto* p_fraps = new Fraps;
  p_fraps->setLocation(TOP_CENTER);
  GM.tick();
  EXPECT_EQ(p_fraps->getValue(), 30);
  EXPECT_NE(topRow().find("fps 30"), std::string::npos) << topRow();
  press(Keyboard::F11);
  EXPECT_TRUE(p_fraps->isVisible());
  press(Keyboard::F9);
  GM.tick();
  EXPECT_EQ(topRow().find("fps"), std::string::npos) << topRow();
  press(Keyboard::F9);
  EXPECT_TRUE(p_fraps->isVisible());
}

TEST_F(FrapsTest, AFireworkLivesAsLongAsAParticle) {
  const int id = (new Firework(2, 3, 255, 255, 0, 0))->getId();
  for (int i = 0; i < 2; ++i) GM.tick();
  EXPECT_NE(WM.objectWithId(id), nullptr);
  for (int i = 0; i < 3; ++i) GM.tick();
  EXPECT_EQ(WM.objectWithId(id), nullptr);
}

}  // namespace
}  // namespace df::test
