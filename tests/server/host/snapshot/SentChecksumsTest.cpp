#include <gtest/gtest.h>

#include <optional>

#include "host/snapshot/SentChecksums.h"

namespace naiad {
namespace {

constexpr std::optional<bool> kUnknown = std::nullopt;

/// Snapshots 1 … 6 with the checksums 10 … 60.
class SentChecksumsTest : public testing::Test {
 protected:
  SentChecksumsTest() {
    for (std::uint32_t number = 1; number <= 6; ++number) sums.recordSent(number, 10 * number);
  }
  static AckWindow allBut(std::uint32_t missing) {
    AckWindow acks;
    for (std::uint32_t number = 1; number <= 6; ++number) {
      if (number != missing) acks.addReceived(number);
    }
    return acks;
  }
  static InFlightSnapshots::Snapshot snapshot(std::uint32_t number, bool empty) {
    return {.number = number, .empty = empty, .objects = {}, .names = {}};
  }
  SentChecksums sums;
};

TEST_F(SentChecksumsTest, ComparesWithTheNewestThatArrived) {
  const AckWindow acks = allBut(0);
  EXPECT_EQ(sums.matches(acks, 60), true);
  EXPECT_EQ(sums.matches(acks, 50), false);
  EXPECT_EQ(sums.matches({7, ~std::uint64_t{0}}, 70), kUnknown) << "not sent";
}

TEST_F(SentChecksumsTest, KnowsNothingWhileASnapshotIsUnsettled) {
  EXPECT_EQ(sums.matches(allBut(3), 60), kUnknown);
}

TEST_F(SentChecksumsTest, ALostEmptySnapshotIsNotMissed) {
  sums.recordLost(snapshot(3, true), false, 6);
  EXPECT_EQ(sums.matches(allBut(3), 60), true);
}

TEST_F(SentChecksumsTest, KnowsNothingUntilALossIsRepaired) {
  sums.recordLost(snapshot(3, false), true, 6);
  EXPECT_EQ(sums.matches(allBut(3), 60), kUnknown);
  sums.recordSent(7, 70);
  EXPECT_EQ(sums.matches({7, 0b111011}, 70), kUnknown) << "something is still pending";
  sums.recordComplete(7);
  ASSERT_FALSE((AckWindow{7, 0b110111}.has(3)));
  EXPECT_EQ(sums.matches({7, 0b110111}, 70), true);
  EXPECT_EQ(sums.matches(allBut(3), 60), kUnknown) << "before the repair";
}

TEST_F(SentChecksumsTest, ASnapshotThatWasNotSentIsUnknown) {
  sums.removeNewest(6);
  EXPECT_EQ(sums.matches(allBut(0), 60), kUnknown);
}

TEST_F(SentChecksumsTest, AfterAResetOlderSnapshotsAreUnknown) {
  sums = SentChecksums(7);
  EXPECT_EQ(sums.matches(allBut(0), 60), kUnknown);
  sums.recordSent(7, 70);
  EXPECT_EQ(sums.matches({7, ~std::uint64_t{0}}, 70), true);
}

}  // namespace
}  // namespace naiad
