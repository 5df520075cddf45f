#include <gtest/gtest.h>

#include <set>

#include "host/snapshot/AppearanceIds.h"

namespace naiad {
namespace {

constexpr std::size_t kLargest = kMaxDictionaryGlyphs / 2 / 8;

class AppearanceIdsTest : public testing::Test {
 protected:
  /// Writes the appearance in the form that formOf() returns, and marks its id as used.
  LookForm write(std::uint64_t hash, std::uint32_t snapshot, std::size_t glyphs = 10) {
    const LookForm form = names.formOf(hash, glyphs, snapshot);
    if (form.kind != LookForm::kInline) names.markUsed(hash, snapshot);
    return form;
  }

  AppearanceIds names;
};

TEST_F(AppearanceIdsTest, DefinesUntilADefinitionArrived) {
  const LookForm first = write(111, 1);
  EXPECT_EQ(first.kind, LookForm::kDefined);
  const LookForm second = write(111, 2);
  EXPECT_EQ(second.kind, LookForm::kDefined);
  EXPECT_EQ(second.id, first.id);
  names.confirmArrival(first.id, 111, 1);
  const LookForm third = write(111, 3);
  EXPECT_EQ(third.kind, LookForm::kNamed);
  EXPECT_EQ(third.id, first.id);
}

TEST_F(AppearanceIdsTest, WithinOneSnapshotOneDefinitionIsEnough) {
  EXPECT_EQ(write(111, 1).kind, LookForm::kDefined);
  EXPECT_EQ(write(111, 1).kind, LookForm::kNamed);
  EXPECT_EQ(write(111, 2).kind, LookForm::kDefined) << "the previous one may be lost";
}

TEST_F(AppearanceIdsTest, AFormThatWasNotWrittenDefinesNothing) {
  EXPECT_EQ(names.formOf(111, 10, 1).kind, LookForm::kDefined);
  EXPECT_EQ(names.formOf(111, 10, 1).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, TheLeastRecentlyUsedIdIsReassigned) {
  std::uint32_t snapshot = 0;
  std::uint32_t second = 0;
  std::set<std::uint32_t> ids;
  for (std::uint64_t hash = 1; hash <= kMaxAppearances; ++hash) {
    const LookForm form = write(hash, ++snapshot, 2);
    ASSERT_EQ(form.kind, LookForm::kDefined);
    ASSERT_TRUE(form.id < kMaxAppearances && ids.insert(form.id).second) << hash;
    names.confirmArrival(form.id, hash, snapshot);
    if (hash == 2) second = form.id;
  }
  EXPECT_EQ(write(1, ++snapshot, 2).kind, LookForm::kNamed);  // now appearance 2 is the least recently used
  const LookForm form = write(9999, ++snapshot, 2);
  EXPECT_EQ(form.kind, LookForm::kDefined);
  EXPECT_EQ(form.id, second);
  EXPECT_EQ(write(1, ++snapshot, 2).kind, LookForm::kNamed);
  EXPECT_EQ(write(2, ++snapshot, 2).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, LateArrivalDoesNotConfirmAReassignedId) {
  std::uint32_t snapshot = 0;
  for (std::uint64_t hash = 1; hash <= 8; ++hash) write(hash, ++snapshot, kLargest);
  const LookForm next = write(9, ++snapshot, kLargest);  // gets the id of appearance 1
  names.confirmArrival(next.id, 1, 1);
  EXPECT_EQ(write(9, ++snapshot, kLargest).kind, LookForm::kDefined);
}

// The appearance gets its earlier id again, but the client may still have stored the one that had this id in
// between.
TEST_F(AppearanceIdsTest, AnEarlierDefinitionDoesNotConfirmALaterOne) {
  const LookForm first = write(1, 1, kLargest);
  std::uint32_t snapshot = 1;
  for (std::uint64_t hash = 2; hash <= 9; ++hash) write(hash, ++snapshot, kLargest);  // 9 gets the id of 1
  for (std::uint64_t hash = 2; hash <= 8; ++hash) write(hash, ++snapshot, kLargest);
  const LookForm again = write(1, ++snapshot, kLargest);  // gets the id of appearance 9
  ASSERT_EQ(again.id, first.id);
  names.confirmArrival(first.id, 1, 1);
  EXPECT_EQ(write(1, ++snapshot, kLargest).kind, LookForm::kDefined);
  names.confirmArrival(first.id, 1, snapshot);
  EXPECT_EQ(write(1, ++snapshot, kLargest).kind, LookForm::kNamed);
}

TEST_F(AppearanceIdsTest, TotalGlyphsAreLimited) {
  std::uint32_t snapshot = 0;
  EXPECT_EQ(write(1, ++snapshot, kLargest + 1).kind, LookForm::kInline) << "too large for a name";
  for (std::uint64_t hash = 1; hash <= 20; ++hash) {
    const LookForm form = write(hash, ++snapshot, kLargest);
    EXPECT_EQ(form.kind, LookForm::kDefined);
    EXPECT_LT(form.id, 8u) << "eight of this size are all that is known at a time";
    names.confirmArrival(form.id, hash, snapshot);
  }
  for (std::uint64_t hash = 13; hash <= 20; ++hash)
    EXPECT_EQ(write(hash, 99, kLargest).kind, LookForm::kNamed);
  EXPECT_EQ(write(12, 100, kLargest).kind, LookForm::kDefined);
}

// If an id had two, the client would draw the new appearance where the snapshot names the old one.
TEST_F(AppearanceIdsTest, AnIdHasOneMeaningInASnapshot) {
  for (std::uint64_t hash = 1; hash <= 8; ++hash) names.confirmArrival(write(hash, 1, kLargest).id, hash, 1);
  for (std::uint64_t hash = 1; hash <= 8; ++hash) EXPECT_EQ(write(hash, 2, kLargest).kind, LookForm::kNamed);
  EXPECT_EQ(write(9, 2, kLargest).kind, LookForm::kInline) << "all ids are in use";
  EXPECT_EQ(write(9, 3, kLargest).kind, LookForm::kDefined);
}

TEST_F(AppearanceIdsTest, AResetClientGetsDefinitionsAgain) {
  names.confirmArrival(write(111, 1).id, 111, 1);
  names.clear();
  EXPECT_EQ(write(111, 2).kind, LookForm::kDefined);
}

}  // namespace
}  // namespace naiad
