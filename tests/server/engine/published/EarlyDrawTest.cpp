// Compiled with -DDF_DRAW=void, like games for the first versions of the published engine, in which draw()
// returned nothing.

#include <gtest/gtest.h>

#include "DisplayManager.h"
#include "GameManager.h"
#include "ViewObject.h"
#include "World.h"
#include "engine/world/Capture.h"

namespace df::test {
namespace {

class Platform : public Object {
 public:
  void draw() override {
    Object::draw();
    DM.drawCh(getPosition(), '=', YELLOW);
  }
};

class Title : public ViewObject {
 public:
  void draw() override { DM.drawString(Vector(0, 3), "title", LEFT_JUSTIFIED, WHITE); }
};

TEST(EarlyDraw, DrawFunctionsReturningVoidStillWork) {
  World world;
  const World::Scope scope(world);
  (new Platform)->setPosition(Vector(1, 2));
  new Title;
  GM.tick();
  const auto canvas = world.picture().render(FixedVector());
  EXPECT_EQ(canvas.rowText(2).substr(0, 3), " = ");
  EXPECT_EQ(canvas.rowText(3).substr(0, 6), "title ");
  world.shutDown();
}

}  // namespace
}  // namespace df::test
