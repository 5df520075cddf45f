#include <gtest/gtest.h>

#include <array>

#include "engine/world/DelayedFree.h"

namespace df::test {
namespace {

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
