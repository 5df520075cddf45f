#include <gtest/gtest.h>

#include <chrono>

#include "shared/net/base/LinkStats.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

constexpr PathProbe::Time kProbed{1h};

TEST(PathProbe, IsOpenForASecondAfterEvidence) {
  PathProbe probe(PathProbe::kOpenTime, kProbed);
  EXPECT_FALSE(probe.isOpen(kProbed));
  probe.addEvidence(kProbed);
  EXPECT_TRUE(probe.isOpen(kProbed + 999ms));
  EXPECT_FALSE(probe.isDue(kProbed + 999ms, true));
  EXPECT_FALSE(probe.isOpen(kProbed + 1s));
  EXPECT_TRUE(probe.isDue(kProbed + 1s, false));
}

TEST(PathProbe, MayProbeWhileThePathIsStillOpen) {
  PathProbe probe(400ms, kProbed - 1min);
  probe.addEvidence(kProbed);
  EXPECT_FALSE(probe.isDue(kProbed + 399ms, true));
  EXPECT_TRUE(probe.isDue(kProbed + 400ms, false));
  probe.probeSent(kProbed + 400ms);
  EXPECT_FALSE(probe.isDue(kProbed + 499ms, false));
  EXPECT_TRUE(probe.isDue(kProbed + 500ms, false));
}

TEST(PathProbe, WithoutEvidenceProbesAreOneSecondApart) {
  PathProbe probe(400ms, kProbed - 1min);
  probe.probeSent(kProbed);
  EXPECT_FALSE(probe.isDue(kProbed + 999ms, false));
  EXPECT_TRUE(probe.isDue(kProbed + 250ms, true)) << "there is no other way";
  EXPECT_TRUE(probe.isDue(kProbed + 1s, false));
}

}  // namespace
}  // namespace naiad
