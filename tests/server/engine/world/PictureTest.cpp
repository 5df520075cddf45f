#include <gtest/gtest.h>

#include "engine/world/Capture.h"
#include "tests/server/engine/Probe.h"
#include "tests/server/engine/world/Parts.h"

namespace df::test {
namespace {

TEST(Picture, ShowsCharactersUntilTheNextOne) {
  Parts parts;
  parts.picture.add({fromCells(3), fromCells(2)}, U'x', RED);
  EXPECT_EQ(parts.picture.render({}).at(3, 2).ch, U'x');
  EXPECT_EQ(parts.picture.render({fromCells(1), 0}).at(2, 2).ch, U'x');
  parts.picture.clearPicture();
  EXPECT_EQ(parts.picture.render({}).at(3, 2).ch, U' ');
}

TEST(Picture, StaticLookIsDrawnAgainAfterReturning) {
  Parts parts;
  Probe probe;
  int drawn = 0;
  probe.on_draw = [&](Probe&) { ++drawn; };
  probe.setStaticLook();
  parts.picture.drawAll();
  parts.picture.drawAll();
  EXPECT_EQ(drawn, 1);
  parts.objects.removeObject(&probe);
  parts.objects.insertObject(&probe);
  parts.picture.drawAll();
  EXPECT_EQ(drawn, 2);
}

TEST(Picture, ViewIsFilledWhileWatched) {
  Parts parts;
  const Probe probe;
  parts.state.step_count = 5;
  parts.picture.finishView();
  EXPECT_TRUE(parts.picture.view().changed.empty());
  parts.store.setWatched(true);
  parts.picture.finishView();
  EXPECT_EQ(parts.picture.view().tick, 5u);
  ASSERT_EQ(parts.picture.view().changed.size(), 1u);
  EXPECT_EQ(parts.picture.view().changed[0].key, probe.key());
}

}  // namespace
}  // namespace df::test
