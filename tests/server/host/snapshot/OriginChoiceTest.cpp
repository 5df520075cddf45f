#include <gtest/gtest.h>

#include "host/snapshot/PerClientState.h"

namespace naiad {
namespace {

WorldRecord worldOf(std::int32_t width, std::int32_t height) {
  return {.boundary = {}, .view_width = width, .view_height = height};
}

TEST(OriginChoice, AWindowServesAViewThatMovesALittle) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  EXPECT_EQ(choice.slot(), 0u);
  const std::uint32_t slot = choice.updateWindow({100, 50}, world, 1);
  ASSERT_NE(slot, 0u);
  EXPECT_LE(choice.at(slot).corner.x, 96);
  EXPECT_GE(choice.at(slot).corner.x + (1 << choice.at(slot).x_bits), 184);
  for (int d = -4; d <= 4; ++d) EXPECT_EQ(choice.updateWindow({100 + d, 50 + d}, world, 1), 0u) << d;
}

TEST(OriginChoice, SnapshotsNameAWindowOnceItIsConfirmed) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  const std::uint32_t first = choice.updateWindow({0, 0}, world, 1);
  EXPECT_EQ(choice.slot(), 0u);
  choice.confirmArrival(first);
  EXPECT_EQ(choice.slot(), first);
  const std::uint32_t second = choice.updateWindow({500, 0}, world, 1);
  EXPECT_NE(second, 0u);
  EXPECT_NE(second, first) << "snapshots on their way name that one";
  EXPECT_EQ(choice.slot(), first);
  choice.confirmArrival(first);
  EXPECT_EQ(choice.slot(), first) << "a late acknowledgement of the old one";
  choice.confirmArrival(second);
  EXPECT_EQ(choice.slot(), second);
}

TEST(OriginChoice, AnUnconfirmedWindowIsSetAgain) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  const std::uint32_t slot = choice.updateWindow({0, 0}, world, 1);
  EXPECT_EQ(choice.updateWindow({500, 0}, world, 1), slot);
  EXPECT_LE(choice.at(slot).corner.x, 500);
}

TEST(OriginChoice, ADistantOrderNeedsANewWindow) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  EXPECT_NE(choice.updateWindow({0, 0}, world, 1), 0u);
  EXPECT_EQ(choice.updateWindow({0, 0}, world, 10'000), 0u);
  EXPECT_NE(choice.updateWindow({0, 0}, world, 20'000), 0u);
}

TEST(OriginChoice, ALargerViewNeedsALargerWindow) {
  OriginChoice choice;
  EXPECT_NE(choice.updateWindow({0, 0}, worldOf(80, 24), 1), 0u);
  EXPECT_NE(choice.updateWindow({0, 0}, worldOf(160, 24), 1), 0u);
}

}  // namespace
}  // namespace naiad
