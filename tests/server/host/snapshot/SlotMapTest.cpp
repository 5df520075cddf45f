#include <gtest/gtest.h>

#include <map>

#include "host/snapshot/SlotMap.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

TEST(SlotMap, AgreesWithTheStandardMap) {
  for (const std::uint32_t spread : {1u, 128u, 4096u}) {  // the hash ignores low bits
    SplitMix64 rng(spread);
    SlotMap map;
    EXPECT_EQ(map.find(0), SlotMap::kNone);
    std::map<std::uint32_t, std::uint32_t> plain;
    std::size_t most = 0;
    for (int i = 0; i < 60'000; ++i) {
      const auto slot = static_cast<std::uint32_t>(rng.below(256)) * spread;
      const bool adds = rng.below(100) < ((i / 5000) % 2 == 0 ? 70u : 30u);
      if (adds && plain.count(slot) == 0) {
        map.insert(slot, static_cast<std::uint32_t>(i));
        plain[slot] = static_cast<std::uint32_t>(i);
      } else if (!adds && plain.count(slot) == 1) {
        map.erase(slot);
        plain.erase(slot);
      }
      most = std::max(most, plain.size());
      if (i % 50 != 0) continue;
      for (std::uint32_t s = 0; s < 256; ++s) {
        const auto found = plain.find(s * spread);
        ASSERT_EQ(map.find(s * spread), found == plain.end() ? SlotMap::kNone : found->second)
            << "step " << i;
      }
    }
    EXPECT_GT(most, 150u);
  }
}

}  // namespace
}  // namespace naiad
