// In compat mode, the memory of deleted Objects is kept for a while, because games call their getters.

#include <array>
#include <memory>

#include "engine/events/EventStep.h"
#include "engine/world/DelayedFree.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/Sanitizers.h"

namespace df::test {
namespace {

class DelayedFreeTest : public WorldTest {
 protected:
  void SetUp() override {
    if (naiad::test::kSanitized)
      GTEST_SKIP() << "a sanitizer stops accesses to a deleted Object, as it should";
    world.setCompat();
  }
};

TEST(DelayedFree, KeepsALimitedNumberOfBlocks) {
  constexpr std::align_val_t kAlign{64};
  const auto p_freed = std::make_unique<DelayedFree>();
  DelayedFree& freed = *p_freed;
  std::vector<void*> blocks;
  for (std::size_t i = 0; i < DelayedFree::kMaxKept + 10; ++i) {
    blocks.push_back(::operator new(200, kAlign));
    freed.free(blocks.back(), kAlign);
    EXPECT_EQ(freed.size(), std::min(i + 1, DelayedFree::kMaxKept));
  }
  // A new allocation must not reuse a block that is kept.
  void* const p_fresh = ::operator new(200, kAlign);
  for (std::size_t i = 10; i < blocks.size(); ++i) EXPECT_NE(p_fresh, blocks[i]);
  ::operator delete(p_fresh, kAlign);
}

TEST_F(DelayedFreeTest, GettersOfADeletedObjectStillWork) {
  Object* p_gone = new Probe("gone", nullptr, Vector(3, 4));
  p_gone->setVelocity(Vector(1, 0));
  Shape shape;
  shape.setSize(5);
  p_gone->setShape(shape);
  const int id = p_gone->getId();
  WM.markForDelete(p_gone);
  world.update();
  ASSERT_EQ(WM.objectWithId(id), nullptr);
  p_gone->getPosition();
  p_gone->getType();
  EXPECT_NE(p_gone->getShape().getSize(), 5) << "it has no extras any more";
  EXPECT_EQ(p_gone->getAnimation().getSprite(), nullptr);
  EXPECT_EQ(p_gone->setPosition(Vector(5, 5)), 0);
  EXPECT_EQ(p_gone->getWorld(), nullptr);
  EXPECT_EQ(p_gone->registerInterest(STEP_EVENT), -1);
  Sprite blinking = spriteOf({"*", "+"});
  p_gone->setSprite(&blinking);
  world.tick();
  EXPECT_EQ(p_gone->draw(), 0);
  const EventStep step;
  EXPECT_EQ(p_gone->eventHandler(&step), 0);
}

TEST_F(DelayedFreeTest, SecondDeleteSparesTheSlotsNextObject) {
  Object* p_gone = new Probe("gone");
  WM.markForDelete(p_gone);
  world.update();
  std::vector<Object*> others;
  for (int i = 0; i < 200; ++i) {
    others.push_back(new Probe("other"));
    world.update();
  }
  EXPECT_EQ(WM.markForDelete(p_gone), -1);
  EXPECT_EQ(WM.removeObject(p_gone), -1);
  EXPECT_EQ(WM.insertObject(p_gone), -1);
  world.update();
  EXPECT_EQ(WM.getAllObjects().getCount(), 200);
}

TEST(PendingBlocks, BlockIsClaimedOnceByAnyAddressInIt) {
  std::array<std::byte, 32> memory;
  PendingBlocks blocks;
  blocks.push(memory.data(), 16);
  EXPECT_FALSE(blocks.claim(memory.data() + 16));
  EXPECT_TRUE(blocks.claim(memory.data() + 15));
  EXPECT_FALSE(blocks.claim(memory.data() + 15));
}

TEST(PendingBlocks, CancelledBlockLeavesTheOthers) {
  std::array<std::byte, 32> memory;
  PendingBlocks blocks;
  blocks.push(memory.data(), 16);
  blocks.push(memory.data() + 16, 16);
  blocks.cancel(memory.data());
  EXPECT_FALSE(blocks.claim(memory.data()));
  EXPECT_TRUE(blocks.claim(memory.data() + 16));
}

}  // namespace
}  // namespace df::test
