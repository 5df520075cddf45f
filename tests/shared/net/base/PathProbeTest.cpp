#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/PathProbe.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr PathProbe::Time kStart{1h};

TEST(PathProbe, IsOpenForASecondAfterEvidence) {
  PathProbe probe(PathProbe::kOpenFor, kStart);
  EXPECT_FALSE(probe.isOpen(kStart));
  probe.addEvidence(kStart);
  EXPECT_TRUE(probe.isOpen(kStart + 999ms));
  EXPECT_FALSE(probe.isDue(kStart + 999ms, true));
  EXPECT_FALSE(probe.isOpen(kStart + 1s));
  EXPECT_TRUE(probe.isDue(kStart + 1s, false));
}

TEST(PathProbe, MayBeginWhileThePathIsStillOpen) {
  PathProbe probe(400ms, kStart - 1min);
  probe.addEvidence(kStart);
  EXPECT_FALSE(probe.isDue(kStart + 399ms, true));
  EXPECT_TRUE(probe.isDue(kStart + 400ms, false));
  probe.probeSent(kStart + 400ms);
  EXPECT_FALSE(probe.isDue(kStart + 499ms, false));
  EXPECT_TRUE(probe.isDue(kStart + 500ms, false));
}

TEST(PathProbe, WithoutEvidenceEverThereIsNothingToBeEagerAbout) {
  PathProbe probe(400ms, kStart - 1min);
  probe.probeSent(kStart);
  EXPECT_FALSE(probe.isDue(kStart + 999ms, false));
  EXPECT_TRUE(probe.isDue(kStart + 250ms, true)) << "there is no other way";
  EXPECT_TRUE(probe.isDue(kStart + 1s, false));
}

}  // namespace
}  // namespace naiad
