// Runs the functions that EarlyNamesTest.cpp and LaterNamesTest.cpp compile, and tests behaviour behind them.

#include "Animation.h"
#include "Config.h"
#include "tests/server/engine/Probe.h"

int earlyCollisions(df::Object* p_o, df::Vector where);
std::string earlySprites(df::Object* p_o);
bool earlyText(df::Object* p_o);
bool earlyVelocity(df::Object* p_o);
int earlyDraw(df::Vector where, bool centered);
int earlyNames();
int laterNames();

namespace df::test {
namespace {

class EarlyNames : public WorldTest {
 protected:
  EarlyNames() {
    m_arrow.setWidth(3);
    m_arrow.setHeight(2);
    m_arrow.setLabel("arrow");
    m_arrow.addFrame(Frame(3, 2, "a/>bc("));
  }
  /// Returns six cells of rows 10 and 11 of the picture, from column 8 on.
  std::string shown() {
    world.tick();
    const Canvas canvas = world.picture().render({});
    return canvas.rowText(10).substr(8, 6) + "|" + canvas.rowText(11).substr(8, 6);
  }

  Sprite m_arrow{1};
};

TEST_F(EarlyNames, StillCompileAndRun) {
  EXPECT_EQ(earlyNames(), 0);
  world.tick();
  EXPECT_EQ(WM.getAllObjects().getCount(), 0) << "the splash goes by itself";
}

TEST_F(EarlyNames, LaterVersionsNamesCompileAndRun) {
  EXPECT_EQ(laterNames(), 0);
}

TEST_F(EarlyNames, IsCollisionConvertsToListAndBool) {
  Probe mover("mover");
  Probe wall("wall", nullptr, Vector(5, 5));
  Probe other("other", nullptr, Vector(5.5, 5));
  EXPECT_EQ(earlyCollisions(&mover, Vector(5, 5)), 2);
  EXPECT_EQ(earlyCollisions(&mover, Vector(20, 5)), 0);
}

TEST_F(EarlyNames, SerializeAcceptsABoolFlag) {
  Probe probe;
  EXPECT_TRUE(earlyText(&probe));
}

TEST_F(EarlyNames, PositionAndVelocityHaveNamesOfFourPointOne) {
  Probe probe;
  EXPECT_TRUE(earlyVelocity(&probe));
}

TEST_F(EarlyNames, FramesAreDrawnAroundOrFromThePosition) {
  struct Drawn : PlacedObject {
    using PlacedObject::PlacedObject;
    int draw() override { return earlyDraw(getPosition(), centered); }
    bool centered = false;
  };
  Drawn o(Vector(9, 10));
  EXPECT_EQ(shown(), " abc  |  ef  ");
  o.centered = true;
  o.setPosition(Vector(10, 10.5));
  EXPECT_EQ(shown(), " abc  |  ef  ");
}

TEST_F(EarlyNames, UncentredSpriteStartsAtThePosition) {
  PlacedObject o(Vector(9, 10.5));
  o.setSprite(&m_arrow);
  EXPECT_EQ(earlySprites(&o), "arrow");
  EXPECT_EQ(shown(), "a/>   |bc(   ");
  o.setPosition(Vector(9, 10));
  o.setCentered(false);
  EXPECT_EQ(shown(), " a/>  | bc(  ");
  EXPECT_EQ(o.getBox(), Box(Vector(-0.5, -0.5), 3, 2));
  o.setCentered();
  EXPECT_EQ(o.getBox(), m_arrow.getBox());
}

TEST_F(EarlyNames, TransformedSpriteIsDrawnFlipped) {
  PlacedObject o(Vector(9, 10.5));
  o.setSprite(&m_arrow);
  Animation animation = o.getAnimation();
  animation.setTransform(Transform::HORIZONTAL);
  o.setAnimation(animation);
  EXPECT_EQ(shown(), "<\\a   |)cb   ");
  animation.setTransform(Transform::VERTICAL);
  o.setAnimation(animation);
  EXPECT_EQ(shown(), "bc(   |a\\>   ");
  animation.setTransform(Transform::BOTH);
  o.setAnimation(animation);
  EXPECT_EQ(shown(), ")cb   |</a   ");
}

}  // namespace
}  // namespace df::test
