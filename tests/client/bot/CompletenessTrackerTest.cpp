#include <gtest/gtest.h>

#include "client/bot/TruthRecorder.h"

namespace naiad {
namespace {

/// Applies snapshots, each of its own tick. Tests choose their numbers and whether they are complete.
class CompletenessTrackerTest : public testing::Test {
 protected:
  bool addSnapshot(std::uint32_t number, bool complete) {
    acks.addReceived(number);
    SnapshotHeader header;
    header.number = number;
    header.tick = 100 + number;
    header.complete = complete;
    picture.addSnapshot(header, acks);
    return picture.isComplete();
  }
  CompletenessTracker picture;
  AckWindow acks;
};

TEST_F(CompletenessTrackerTest, NeedsACompleteSnapshotAndAllBeforeIt) {
  EXPECT_FALSE(picture.isComplete());
  EXPECT_FALSE(addSnapshot(1, false));
  EXPECT_TRUE(addSnapshot(2, true));
  EXPECT_FALSE(addSnapshot(4, true)) << "what was in 3 is not there";
  EXPECT_TRUE(addSnapshot(3, false)) << "now it is, and 4 is complete";
}

TEST_F(CompletenessTrackerTest, LateSnapshotDoesNotMoveTheTickBack) {
  addSnapshot(1, true);
  addSnapshot(5, true);
  EXPECT_FALSE(addSnapshot(3, true));
  EXPECT_EQ(picture.tick(), 105u);
}

TEST_F(CompletenessTrackerTest, MissingSnapshotMattersUntil65NewerOnesArrive) {
  addSnapshot(1, true);
  for (std::uint32_t number = 3; number <= 66; ++number) EXPECT_FALSE(addSnapshot(number, true)) << number;
  EXPECT_TRUE(addSnapshot(67, true)) << "by then what was in 2 was sent again";
}

TEST_F(CompletenessTrackerTest, ResumedSessionNeedsNoEarlierSnapshots) {
  acks.addReceived(8);
  SnapshotHeader header;
  header.number = 8;
  header.complete = true;
  picture.addSnapshot(header, acks, 6);
  EXPECT_FALSE(picture.isComplete()) << "7 is missing";
  picture.addSnapshot(header, acks, 7);
  EXPECT_TRUE(picture.isComplete());
}

}  // namespace
}  // namespace naiad
