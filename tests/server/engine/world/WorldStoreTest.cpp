#include <algorithm>
#include <memory>

#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using Store = WorldTest;

TEST_F(Store, FreedSlotIsReusedOnlyAfterARest) {
  auto first = std::make_unique<Object>();
  const ObjectKey dead = first->key();
  first.reset();
  for (std::uint64_t i = 1; i < WorldStore::kSlotReuseDelay; ++i) WM.update();
  const Object early;
  EXPECT_NE(early.key().slot, dead.slot);
  WM.update();
  const Object late;
  EXPECT_EQ(late.key().slot, dead.slot);
  EXPECT_GT(late.key().generation, dead.generation);
}

TEST_F(Store, ChurnDoesNotGrowTheStore) {
  std::uint32_t highest = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    auto* p_o = new Object;
    highest = std::max(highest, p_o->key().slot);
    WM.markForDelete(p_o);
    WM.update();
  }
  EXPECT_LE(highest, WorldStore::kSlotReuseDelay + 1);
}

}  // namespace
}  // namespace df::test
