#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "host/snapshot/ChangeIndex.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

CompactRect randomRect(SplitMix64& rng) {
  const auto left = static_cast<std::int64_t>(rng.below(60)) - 30;
  const auto top = static_cast<std::int64_t>(rng.below(60)) - 30;
  return CompactRect({left, top, left + 1 + static_cast<std::int64_t>(rng.below(9)),
                      top + 1 + static_cast<std::int64_t>(rng.below(9))});
}

std::vector<std::size_t> marked(const ChangeIndex::Marks& marks) {
  std::vector<std::size_t> all;
  ChangeIndex::forEachMarked(marks, [&all](std::size_t i) { all.push_back(i); });
  return all;
}

TEST(ChangeIndex, MarksTheSameChangesAsAFullScan) {
  SplitMix64 rng(1);
  ChangeIndex index;
  ChangeIndex::Marks marks;
  for (std::size_t count = 0; count < 200; ++count) {
    index.clear();
    std::set<std::uint32_t> slots;
    while (slots.size() < count) slots.insert(static_cast<std::uint32_t>(rng.below(SlotBits::kBits)));
    const std::vector<std::uint32_t> changed(slots.begin(), slots.end());
    std::vector<CompactRect> sweeps;
    for (const std::uint32_t slot : changed) {
      sweeps.push_back(rng.below(8) == 0 ? CompactRect::nowhere() : randomRect(rng));
      index.add(slot, sweeps.back());
    }
    SlotBits known;
    for (int i = 0; i < 300; ++i) known.set(static_cast<std::uint32_t>(rng.below(SlotBits::kBits)));
    const CompactRect view = randomRect(rng);

    std::vector<std::size_t> meeting;
    std::vector<std::size_t> all;
    for (std::size_t i = 0; i < count; ++i) {
      if (sweeps[i].meets(view)) meeting.push_back(i);
      if (sweeps[i].meets(view) || known.has(changed[i])) all.push_back(i);
    }
    index.markMeeting(view, marks);
    EXPECT_EQ(marked(marks), meeting);
    index.markShared(known, marks);
    EXPECT_EQ(marked(marks), all);
  }
}

TEST(ChangeIndex, NowhereRectangleMeetsNothing) {
  EXPECT_FALSE(CompactRect::nowhere().meets(CompactRect::everywhere()));
  EXPECT_FALSE(CompactRect::nowhere().meets(CompactRect({-5, -5, 5, 5})));
  EXPECT_TRUE(CompactRect({-5, -5, 5, 5}).meets(CompactRect::everywhere()));
}

TEST(SlotBits, StoreSlotsModuloTheBitCount) {
  SlotBits bits;
  bits.set(70);
  EXPECT_TRUE(bits.has(70));
  EXPECT_TRUE(bits.has(70 + SlotBits::kBits));
  EXPECT_FALSE(bits.has(71));
  bits.clear(70);
  EXPECT_FALSE(bits.has(70));
}

}  // namespace
}  // namespace naiad
