#include "engine/managers/DisplayManager.h"
#include "engine/sprites/Animation.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class AnimationTest : public WorldTest {};

TEST_F(AnimationTest, EachFrameIsShownForSlowdownTicks) {
  Sprite s = spriteOf({"a", "b", "c"}, 2);
  PlacedObject o(Vector(10, 10));
  EXPECT_EQ(o.setSprite(&s), 0);
  EXPECT_EQ(shown(10, 9), "aabbccaab");
}

TEST_F(AnimationTest, SlowdownZeroOrSlowdownCountMinusOneStops) {
  Sprite still = spriteOf({"a", "b"}, 0);
  PlacedObject o(Vector(10, 10));
  o.setSprite(&still);
  EXPECT_EQ(shown(10, 4), "aaaa");
  still.setSlowdown(1);
  EXPECT_EQ(shown(10, 3), "aba");
  Animation animation = o.getAnimation();
  animation.setSlowdownCount(-1);
  o.setAnimation(animation);
  EXPECT_EQ(shown(10, 3), "bbb");
  o.setSpriteSlowdownCount(0);
  EXPECT_EQ(shown(10, 3), "bab");
}

TEST_F(AnimationTest, AdvancesOffScreenButNotInactiveOrInvisible) {
  Sprite s = spriteOf({"a", "b", "c", "d", "e"});
  Object o;
  o.setSprite(&s);
  o.setPosition(Vector(-1000, 0));
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
  o.setVisible(false);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
  o.setVisible();
  o.setActive(false);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
  o.setActive();
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 2);
}

TEST_F(AnimationTest, GameOwnedAnimationAdvancesWhenDrawn) {
  Sprite s = spriteOf({"a", "b"});
  Animation animation;
  EXPECT_EQ(animation.draw(Vector()), -1);
  animation.setSprite(&s);
  Probe probe("probe", nullptr, Vector(5, 10));
  probe.on_draw = [&](Probe& p) { EXPECT_EQ(animation.draw(p.getPosition()), 0); };
  EXPECT_EQ(shown(10, 3), "aba");
  probe.on_draw = [&](Probe& p) { p.Object::draw(); };
  EXPECT_EQ(shown(10, 1), "");  // the Object has no sprite
}

TEST_F(AnimationTest, SpritesAreDrawnAroundThePosition) {
  Sprite s(1);
  s.setWidth(3);
  s.setHeight(2);
  s.setColor(MAGENTA);
  s.addFrame(Frame(3, 2, "abcdef"));
  PlacedObject o(Vector(10, 10));
  o.setSprite(&s);
  world.tick();
  const Canvas canvas = world.picture().render({});
  // Rows 9.5 and 10.5 lie in cells 10 and 11.
  EXPECT_EQ(canvas.rowText(10).substr(9, 3), "abc");
  EXPECT_EQ(canvas.rowText(11).substr(9, 3), "def");
  EXPECT_EQ(canvas.at(10, 10).color, MAGENTA);
}

TEST_F(AnimationTest, TransparentCharactersShowTheBackgroundBlanksDoNot) {
  Sprite s = spriteOf({"a# b"});
  s.setTransparency('#');
  Probe ground("ground", nullptr, Vector(10, 10));
  ground.setAltitude(0);
  ground.on_draw = [](Probe& p) { DM.drawString(p.getPosition(), "....", CENTER_JUSTIFIED, WHITE); };
  Object o;
  o.setSprite(&s);
  o.setPosition(Vector(10, 10));
  world.tick();
  EXPECT_EQ(world.picture().render({}).rowText(10).substr(8, 5), ".a. b");
}

TEST_F(AnimationTest, SpriteSetsTheBoxUnlessDisabled) {
  Sprite s = spriteOf({"abcd"});
  Object o;
  o.setSprite(&s, false);
  EXPECT_EQ(o.getBox(), Box(Vector(-0.5, -0.5), 1, 1));
  o.setSprite(&s);
  EXPECT_EQ(o.getBox(), Box(Vector(-2, -0.5), 4, 1));
  o.setBox(Box(Vector(), 1, 1));
  o.setAnimation(o.getAnimation(), false);
  EXPECT_EQ(o.getBox(), Box(Vector(), 1, 1));
  o.setAnimation(o.getAnimation());
  EXPECT_EQ(o.getBox(), Box(Vector(-2, -0.5), 4, 1));
}

TEST_F(AnimationTest, UnknownSpriteIsRefusedAndShowsAQuestionMark) {
  PlacedObject o(Vector(3, 10));
  EXPECT_EQ(o.setSprite("ghost"), -1);
  EXPECT_EQ(logged("setSprite(\"ghost\") of "), 1);
  ASSERT_NE(o.getSprite(), nullptr);
  EXPECT_EQ(shown(10, 1), "?");
  const Sprite s = spriteOf({"##"}, 0);
  Sprite known = s;
  o.setSprite(&known);
  EXPECT_EQ(o.setSprite("ghost"), -1);
  EXPECT_EQ(o.getSprite(), &known) << "it keeps what it has";
  world.setCompat();
  Object published;
  EXPECT_EQ(published.setSprite("ghost"), -1);
  EXPECT_EQ(published.getSprite(), nullptr);
}

TEST_F(AnimationTest, PreciseCollisionsUseTheShownFrame) {
  Sprite s = spriteOf({"##  ", "  ##"}, 0);
  PlacedObject wall(Vector(20, 10));
  wall.setSprite(&s);
  Object mover;
  mover.setPrecise();
  mover.setPosition(Vector(20, 5));
  // The wall covers cells 19 to 22 (its columns are at 18.5 … 21.5). Frame 0 sets the first two, frame 1 the
  // others.
  EXPECT_EQ(WM.getCollisions(&mover, Vector(19, 10)).getCount(), 1);
  EXPECT_EQ(WM.getCollisions(&mover, Vector(21, 10)).getCount(), 0);
  wall.setSpriteIndex(1);
  EXPECT_EQ(WM.getCollisions(&mover, Vector(19, 10)).getCount(), 0);
  EXPECT_EQ(WM.getCollisions(&mover, Vector(21, 10)).getCount(), 1);
  // If the box differs from the sprite's, all of its cells count.
  wall.setBox(Box(Vector(-2, -0.5), 4, 1.5));
  EXPECT_EQ(WM.getCollisions(&mover, Vector(19, 10)).getCount(), 1);
}

TEST_F(AnimationTest, AStaticLookFollowsTheFrame) {
  Sprite s = spriteOf({"a", "b"});
  PlacedObject o(Vector(10, 10));
  o.setSprite(&s);
  o.setStaticLook();
  EXPECT_EQ(shown(10, 3), "aba");
}

TEST_F(AnimationTest, AnimatedObjectsCanBeRemovedAndReinserted) {
  Sprite s = spriteOf({"a", "b"});
  std::vector<Object*> objects;
  for (int i = 0; i < 5; ++i) {
    objects.push_back(new Object);
    objects.back()->setSprite(&s);
  }
  delete objects[1];
  delete objects[4];
  world.tick();
  EXPECT_EQ(objects[0]->getSpriteIndex(), 1);
  EXPECT_EQ(objects[3]->getSpriteIndex(), 1);
  WM.removeObject(objects[0]);
  world.tick();
  EXPECT_EQ(objects[0]->getSpriteIndex(), 1);  // removed from the world
  EXPECT_EQ(objects[2]->getSpriteIndex(), 0);
  WM.insertObject(objects[0]);
  objects[2]->setSprite(nullptr);
  world.tick();
  EXPECT_EQ(objects[0]->getSpriteIndex(), 0);
  EXPECT_EQ(objects[3]->getSpriteIndex(), 1);
}

TEST(AnimationLife, ObjectsOutliveTheirWorld) {
  Sprite s = spriteOf({"a", "b"});
  auto p_world = std::make_unique<World>();
  Object* p_o = nullptr;
  {
    const World::Scope scope(*p_world);
    p_o = new Object;
    p_o->setSprite(&s);
    p_o->setFollowPath();
  }
  p_world.reset();
  EXPECT_EQ(p_o->getSprite(), &s);
  p_o->setSprite(nullptr);
  delete p_o;
}

}  // namespace
}  // namespace df::test
