#include <gtest/gtest.h>

#include <set>

#include "shared/net/datagram/Seal.h"
#include "shared/values/SplitMix64.h"

namespace naiad {
namespace {

using Result = ReplayWindow::Result;

/// Computes the expected result of check() from all marked numbers.
Result plainly(const std::set<std::uint64_t>& marked, std::uint64_t sequence) {
  if (marked.contains(sequence))
    return *marked.rbegin() - sequence < ReplayWindow::kSize ? Result::kSeen : Result::kTooOld;
  const bool old = !marked.empty() && *marked.rbegin() >= sequence + ReplayWindow::kSize;
  return old ? Result::kTooOld : Result::kNew;
}

TEST(ReplayWindow, MatchesASetOfAllNumbers) {
  SplitMix64 rng(3);
  for (int round = 0; round < 60; ++round) {
    ReplayWindow window;
    std::set<std::uint64_t> marked;
    std::uint64_t around = rng.below(2) ? 0 : rng.next() >> 8;
    const std::uint64_t spread = 1 + rng.below(3000);
    for (int i = 0; i < 3000; ++i) {
      const std::uint64_t jump = rng.below(400) == 0 ? rng.below(5000) : rng.below(3);
      around += jump;
      const std::uint64_t back = rng.below(spread);
      const std::uint64_t sequence = around > back ? around - back : 0;
      const Result verdict = window.check(sequence);
      ASSERT_EQ(verdict, plainly(marked, sequence)) << "round " << round << ", number " << sequence;
      if (verdict != Result::kNew || rng.below(4) == 0)
        continue;  // some numbers are not marked, like those of forged packets
      window.mark(sequence);
      marked.insert(sequence);
      ASSERT_EQ(window.expected(), *marked.rbegin() + 1);
    }
  }
}

TEST(RestoreSequence, MatchesTheRfcExample) {
  EXPECT_EQ(expandSequence(0xa82f30ea + 1, 0x9b32), 0xa82f9b32u);  // RFC 9000, A.3
}

TEST(RestoreSequence, NearbyNumbersAreRestored) {
  SplitMix64 rng(9);
  for (int i = 0; i < 300'000; ++i) {
    const std::uint64_t expected = rng.below(3) == 0 ? rng.below(200'000) : rng.next() >> (2 + rng.below(60));
    const std::uint64_t offset = rng.below(0xffff);  // true number = expected − 32767 … expected + 32767
    if (expected + offset < 0x7fff) continue;
    const std::uint64_t truth = expected + offset - 0x7fff;
    if (truth >= std::uint64_t{1} << 62) continue;
    ASSERT_EQ(expandSequence(expected, static_cast<std::uint16_t>(truth)), truth) << expected;
  }
}

TEST(RestoreSequence, IsNeverBelowZero) {
  for (std::uint32_t wire = 0; wire <= 0xffff; ++wire)
    ASSERT_EQ(expandSequence(0, static_cast<std::uint16_t>(wire)), wire);
}

}  // namespace
}  // namespace naiad
