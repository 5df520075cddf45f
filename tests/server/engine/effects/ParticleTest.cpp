#include "engine/effects/Fader.h"
#include "engine/effects/Particle.h"
#include "engine/published/utility.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class ParticleTest : public WorldTest {
 protected:
  int count() const { return WM.objectsOfType("df-particle").getCount(); }
  char at(int x, int y) const { return static_cast<char>(world.picture().render({}).at(x, y).ch); }
};

TEST_F(ParticleTest, LivesForItsAgeAndShowsItsShape) {
  auto* p_particle = new Particle(10, 3, 255, 255, 0, 0);
  p_particle->setPosition(Vector(5, 5));
  EXPECT_EQ(p_particle->getSolidness(), SPECTRAL);
  ticks(2);
  EXPECT_EQ(at(5, 5), 'O');
  EXPECT_EQ(world.picture().render({}).at(5, 5).color, RED);
  world.tick();
  EXPECT_EQ(count(), 0);
}

TEST_F(ParticleTest, EndsOutsideTheWorld) {
  auto* p_particle = new Particle(2, 1000, 255, WHITE);
  p_particle->setPosition(Vector(79, 5));
  p_particle->setVelocity(Vector(1, 0));
  world.tick();
  EXPECT_EQ(count(), 0);
}

TEST_F(ParticleTest, FaderFadesBeforeItEnds) {
  auto* p_fader = new Fader(10, 10, 250, WHITE);
  p_fader->setPosition(Vector(5, 5));
  std::string seen;
  for (int i = 0; i < 9; ++i) {
    world.tick();
    seen += at(5, 5);
  }
  EXPECT_EQ(seen, "OOOO:::: ");
  world.tick();
  EXPECT_EQ(count(), 0);
}

TEST_F(ParticleTest, FaderOlderThanItsOpacityFadesAllItsLife) {
  auto* p_fader = new Fader(10, 1000, 200, WHITE);
  p_fader->setPosition(Vector(5, 5));
  for (const int opacity : {150, 100, 50, 1}) {
    for (int i = 0; i < (opacity > 1 ? 250 : 249); ++i) world.tick();
    EXPECT_NEAR(p_fader->getShape().getOpacity(), opacity, 1);
  }
}

TEST_F(ParticleTest, EveryKindAppearsMovesAndEnds) {
  for (const ParticleType type : {SMOKE, SPARKS, RINGS, FIREWORKS}) {
    EXPECT_EQ(addParticles(type, Vector(40, 12)), 0);
    EXPECT_GT(count(), 5);
    for (int i = 0; i < 60; ++i) world.tick();
    EXPECT_EQ(count(), 0) << type;
  }
  EXPECT_EQ(addParticles(UNDEFINED_PARTICLE_TYPE, Vector()), -1);
}

TEST_F(ParticleTest, CountSpeedAndAgeMatchTheRequest) {
  EXPECT_EQ(addParticles(7, 0, Vector(40, 12), 0, Vector(1, 0), 0, 10, 0, 0.5, 0, 4, 0, 255, 0, 0, 255, 0, 0),
            0);
  ASSERT_EQ(count(), 7);
  EXPECT_EQ(WM.objectsOfType("df-particle")[0]->getVelocity(), Vector(0.5, 0));
  for (int i = 0; i < 3; ++i) world.tick();
  EXPECT_EQ(count(), 7);
  world.tick();
  EXPECT_EQ(count(), 0);
  EXPECT_EQ(addParticles(1'000'000, 0, Vector(), 0, Vector(), 0, 1, 0, 0, 0, 1, 0, 255, 0, 0, 0, 0, 0), 0);
  EXPECT_EQ(count(), 1000);
}

TEST_F(ParticleTest, PrecipitationReentersTheWorld) {
  EXPECT_EQ(addParticles(RAIN, DOWN), 0);
  EXPECT_EQ(addParticles(SNOW, LEFT), 0);
  EXPECT_EQ(addParticles(STARFIELD, LEFT), 0);
  EXPECT_EQ(addParticles(STARFIELD, UNDEFINED_DIRECTION), -1);
  const int begun = count();
  EXPECT_EQ(begun, 90);
  for (int i = 0; i < 300; ++i) world.tick();
  EXPECT_EQ(count(), begun);
  const ObjectList all = WM.objectsOfType("df-particle");
  for (int i = 0; i < all.getCount(); ++i) {
    EXPECT_TRUE(boxContainsPosition(Box(Vector(-1, -1), 82, 26), all[i]->getPosition()));
  }
}

TEST_F(ParticleTest, ParticlesDoNotUseTheGamesRandomNumbers) {
  World other;
  world.setSeed(5);
  other.setSeed(5);
  addParticles(FIREWORKS, Vector(40, 12));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(world.randomInt(1000), other.randomInt(1000));
}

TEST_F(ParticleTest, AFrameExplodesIntoItsCharacters) {
  Sprite s = spriteOf({"a#b"});
  s.setTransparency('#');
  EXPECT_EQ(explode(&s, 0, Vector(10, 10), 5, 1, 0), 0);
  ASSERT_EQ(count(), 2);
  world.tick();
  EXPECT_EQ(at(8, 10), 'a');
  EXPECT_EQ(at(12, 10), 'b');
  EXPECT_EQ(explode(&s, 1, Vector(), 5, 1, 0), -1);
  EXPECT_EQ(explode(nullptr, 0, Vector(), 5, 1, 0), -1);
  for (int i = 0; i < 5; ++i) world.tick();
  // With a negative speed, the pieces start apart and fly together.
  explode(&s, 0, Vector(10, 10), 5, -1, 0);
  for (int i = 0; i < 4; ++i) world.tick();
  EXPECT_EQ(at(9 - 1, 10), 'a');
}

}  // namespace
}  // namespace df::test
